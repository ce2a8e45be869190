//! Imports that are bound to one buffer.

#![allow(unsafe_code, reason = "imports are promises about handles")]

use crate::bench::{FRAME, TestResult, device, planned};
use framegraph::{Entry, Exit, Graph, Intent, Options};
use framegraph_vulkan::Executor;
use framegraph_vulkan::testing::{self, Mock};

/// One buffer behind two imports is refused, unless the graph declares that they may alias. Then the layers report no
/// missing barrier.
#[test]
fn a_buffer_behind_two_imports_needs_a_declaration() -> TestResult {
    let Some(device) = device("a_buffer_behind_two_imports_needs_a_declaration") else { return Ok(()) };
    for aliases in [false, true] {
        let mut graph = Graph::new();
        let [a, b, c] = ["a", "b", "c"].map(|name| graph.import_buffer(name, 256, Entry::Defined, Exit::Keep));
        if aliases {
            graph.may_alias_buffer(a, b)?;
        }
        let a = graph.add_fn("write", |pass| pass.storage_write_buffer(a, Intent::Overwrite))?;
        let c = graph.add_fn("read", |pass| {
            pass.storage_read_buffer(b)?;
            pass.storage_write_buffer(c, Intent::Overwrite)
        })?;
        let a = graph.add_fn("copy", |pass| {
            pass.copy_source_buffer(c)?;
            pass.copy_target_buffer(a, Intent::Overwrite)
        })?;
        graph.add_fn("again", |pass| {
            pass.storage_read_buffer(b)?;
            pass.storage_write_buffer(c, Intent::Modify)
        })?;
        let plan = planned(&device, &graph, &Options::for_frame(FRAME[0], FRAME[1]), |_| {})?;
        let (mut executor, mut mock) = (Executor::new(device.gpu())?, Mock { kit: testing::Kit::new(device.gpu()) });
        let mut imports = testing::imports(&mut mock.kit, &plan)?;
        let [a, b] = [a, b].map(|buffer| graph.resource_of_buffer(buffer));
        let (a, b) = (a.ok_or("a is an import")?, b.ok_or("b is an import")?);
        let shared = imports.bound_buffer(a).ok_or("a is bound")?;
        // SAFETY: the buffer of `a` has the size and the usages that `testing` gives to all buffers.
        unsafe { imports.buffer(b, shared) };
        let done = executor.execute(&plan, imports, |cx| mock.record(cx));
        match done {
            Ok(()) => assert!(aliases),
            Err(error) => {
                let told = error.to_string();
                assert!(
                    !aliases && told.starts_with("a: it is bound to the image or buffer of the import b"),
                    "{told}"
                );
            }
        }
        executor.wait()?;
        assert_eq!(device.messages(), [""; 0]);
    }
    Ok(())
}
