//! Textures padded by a driver: the heap uses the sizes of the caps, and histories are placed separately on request.

use framegraph::*;
use framegraph_check::check;
use framegraph_check::generate::{self, Entropy, FRAME, Profile};

/// Returns caps rows in which every texture of the graph needs a third more than its texels, plus 100 bytes.
fn padded(graph: &Graph) -> Vec<(TextureDesc, u64)> {
    let textures = graph.resources().iter().filter_map(|row| row.desc.texture());
    let absolute = textures.map(|desc| {
        let [width, height] = desc.extent.texels(FRAME);
        desc.extent(Extent::absolute(width, height))
    });
    absolute.map(|desc| (desc, desc.bytes(FRAME) / 3 * 4 + 100)).collect()
}

#[test]
fn a_heap_gives_what_the_driver_pads() {
    let options = Options { alias: Alias::Heap, inline: false, ..Options::for_frame(FRAME[0], FRAME[1]) };
    let (mut scratch, mut plan, mut placed, mut apart) = (Scratch::new(), Plan::new(), 0, 0);
    for seed in 0..120 {
        let graph = generate::graph(&mut Entropy::seeded(seed), &Profile::default());
        let padded = padded(&graph);
        let caps = Caps { placed_histories: false, padded, texture_alignment_bytes: 16, ..Caps::desktop() };
        if compile(&graph, &caps, &options, &mut scratch, &mut plan).is_err() {
            continue;
        }
        assert_eq!(check(&plan), Ok(()), "seed {seed}");
        for (declared, row) in graph.resources().iter().zip(plan.resources()) {
            let texels = declared.desc.bytes(FRAME);
            match (row.placement, declared.kind, declared.desc) {
                (Placement::Heap { .. }, Kind::Transient, Desc::Texture(_)) => {
                    assert_eq!(row.bytes, texels / 3 * 4 + 100, "seed {seed}");
                    placed += 1;
                }
                (Placement::Heap { .. }, kind, desc) => {
                    assert!(kind == Kind::Transient && desc.texture().is_none(), "seed {seed}: {kind:?} is placed");
                }
                (_, Kind::HistoryCurrent { .. }, _) => apart += 1,
                _ => {}
            }
        }
    }
    assert!(placed > 50 && apart > 5, "{placed} textures are placed, {apart} histories lie apart");
}
