//! Imports that are bound to one buffer or image.

#![allow(unsafe_code, reason = "imports are promises about handles")]

use crate::bench::{FRAME, TestResult, device, planned};
use framegraph::{Entry, Exit, Extent, Format, Graph, Intent, Options, Stages, State, TextureDesc};
use framegraph_vulkan::Executor;
use framegraph_vulkan::ash::vk;
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
                    !aliases
                        && told.starts_with(
                            "a: it is bound to the buffer of the import b; declare `Graph::may_alias_buffer`"
                        ),
                    "{told}"
                );
            }
        }
        executor.wait()?;
        assert_eq!(device.messages(), [""; 0]);
    }
    Ok(())
}

/// One image behind two imports that passes only read is accepted in one state. Otherwise the barriers of one import
/// would change the layout behind the other one.
#[test]
fn an_image_behind_two_read_only_imports_needs_one_state() -> TestResult {
    let Some(device) = device("an_image_behind_two_read_only_imports_needs_one_state") else { return Ok(()) };
    for (copies, entry) in [(false, Entry::Defined), (true, Entry::Defined), (false, left(State::CopySource))] {
        let mut graph = Graph::new();
        let desc = TextureDesc::new(Extent::FRAME, Format::Rgba8Unorm);
        let a = graph.import_texture("a", desc, Entry::Defined, Exit::Keep);
        let b = graph.import_texture("b", desc, entry, Exit::Keep);
        let [first, second] = ["first", "second"].map(|name| graph.texture(name, desc));
        let first = graph.add_fn("sample", |pass| {
            pass.sampled(a)?;
            pass.color(first, Intent::Overwrite)
        })?;
        let second = graph.add_fn("again", |pass| {
            if copies {
                pass.copy_source(b)?;
                return pass.copy_target(second, Intent::Overwrite);
            }
            pass.sampled(b)?;
            pass.color(second, Intent::Overwrite)
        })?;
        graph.export(first)?;
        graph.export(second)?;
        let plan = planned(&device, &graph, &Options::for_frame(FRAME[0], FRAME[1]), |_| {})?;
        let (mut executor, mut mock) = (Executor::new(device.gpu())?, Mock { kit: testing::Kit::new(device.gpu()) });
        let mut imports = testing::imports(&mut mock.kit, &plan)?;
        let [a, b] = [a, b].map(|texture| graph.resource_of(texture));
        let (a, b) = (a.ok_or("a is an import")?, b.ok_or("b is an import")?);
        let shared = imports.bound_image(a).ok_or("a is bound")?;
        // SAFETY: the image of `a` has the shape and the usages that `testing` gives to all images, and is in this layout.
        unsafe { imports.image(b, shared, vk::ImageLayout::SHADER_READ_ONLY_OPTIMAL) };
        let done = executor.execute(&plan, imports, |cx| mock.record(cx)).map_err(|error| error.to_string());
        let one_state = !copies && entry == Entry::Defined;
        let refused = "a: it is bound to the image of the import b; import it once".to_owned();
        assert_eq!(done, if one_state { Ok(()) } else { Err(refused) });
        executor.wait()?;
        assert_eq!(device.messages(), [""; 0]);
    }
    Ok(())
}

fn left(state: State) -> Entry {
    Entry::Left { state, stages: Stages::COPY }
}
