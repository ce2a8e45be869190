//! Check of ownership: every queue owns the resources whose contents it uses.
//!
//! Drivers and validation layers cannot detect a missing transfer on a device whose queues share a family. This check
//! runs when a plan is prepared, on any device.

use crate::error::Error;
use framegraph::{Access, Kind, Plan, ResourceId};
use framegraph_queues::{Command, QueueId, Schedule};

/// Simulates the commands and fails at the first use of contents by a queue that does not own them.
pub(crate) fn check_owners(plan: &Plan, schedule: Option<&Schedule>, commands: &[Command]) -> Result<(), Error> {
    let Some(schedule) = schedule else { return Ok(()) };
    let graph = plan.graph();
    // `None`: concurrent, or without contents.
    let mut owners: Vec<Option<QueueId>> = graph
        .resources()
        .iter()
        .map(|row| if row.kind == Kind::Transient { None } else { Some(QueueId::MAIN) })
        .collect();
    let mut concurrent = vec![false; owners.len()];
    let use_it = |owners: &mut [Option<QueueId>], queue: QueueId, access: &Access| {
        let at = access.resource.index();
        let whole = access.range == framegraph::Range::ALL && !access.mode.needs_contents();
        match owners[at] {
            Some(owner) if owner != queue && !whole => Err(Error::Owner {
                resource: graph.resource_name(ResourceId::at(at)).to_owned(),
                queue: queue.index(),
                owner: owner.index(),
            }),
            _ => {
                owners[at] = Some(queue);
                Ok(())
            }
        }
    };
    for command in commands {
        match *command {
            Command::Create { resource, concurrent: true, .. } => concurrent[resource.index()] = true,
            Command::Acquire { transfer, .. } => {
                let row = &schedule.transfers[transfer as usize];
                owners[row.resource.index()] = Some(row.to.0);
            }
            Command::Pass { queue, pass, .. } => {
                let own = graph.accesses_of(pass).iter();
                for access in own.filter(|access| !concurrent[access.resource.index()]) {
                    use_it(&mut owners, queue, access)?;
                }
            }
            _ => {}
        }
    }
    Ok(())
}
