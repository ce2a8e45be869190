//! Settings as files: the document's description, and frames as graphs.

use super::TestResult;
use crate::stage::declared;
use framegraph::file::{GraphFile, to_ron};
use framegraph::{Caps, Options, Plan, Scratch, compile, dump};
use framegraph_passes::quality::GROUPS;
use framegraph_passes::{FrameSettings, Preset, Settings};

const DOCUMENT: &str = include_str!("../../../../docs/reference/settings.md");

#[test]
fn the_examples_of_the_document_load() -> TestResult {
    let examples: Vec<&str> = DOCUMENT.split("```ron\n").skip(1).filter_map(|rest| rest.split("```").next()).collect();
    assert_eq!(examples.len(), 2);
    for example in examples {
        let frame = FrameSettings::from_ron("docs/reference/settings.md", example)?;
        assert_ne!(frame, FrameSettings::DEFAULT, "{example}");
        assert_eq!(FrameSettings::from_ron("again", &frame.to_ron()?)?, frame);
    }
    Ok(())
}

/// The document's row of each preset matches the code.
#[test]
fn the_document_has_the_presets() {
    let row = |name: &str| {
        let line = DOCUMENT.lines().find(|line| line.starts_with(&format!("| {name} |"))).expect("a row of the table");
        line.trim_matches('|').split('|').skip(1).map(|cell| cell.trim().to_owned()).collect::<Vec<_>>()
    };
    for (column, preset) in Preset::ALL.into_iter().enumerate() {
        let frame = preset.frame();
        let shadows = frame.settings.shadows.expect("every preset has shadows");
        assert_eq!(row("maps of lamps")[column], shadows.local_maps.to_string());
        for group in &GROUPS {
            let option = group.option(&row(group.name)[column]).expect("an option of the group");
            let mut same = frame;
            (option.apply)(&mut same);
            assert_eq!(same, frame, "{preset:?}: {} is not {}", group.name, option.name);
        }
    }
}

#[test]
fn frames_load_as_graphs_with_the_same_plan() -> TestResult {
    let every = Settings { blended: true, scene_levels: 4, glass_layers: 2, ..Preset::Ultra.frame().settings };
    let frames = Preset::ALL.map(|preset| preset.frame().settings).into_iter().chain([every]);
    for settings in frames {
        let (frame, _) = declared(&settings);
        let text = to_ron(frame.graph(), "frame", [640, 360]);
        let graph = GraphFile::parse("frame.ron", &text)?.graph(&[])?;
        let plan = |graph| {
            let mut plan = Plan::new();
            let options = Options::for_frame(640, 360);
            compile(graph, &Caps::wgpu(), &options, &mut Scratch::new(), &mut plan).map(|()| {
                // Files do not contain the reasons for effects.
                let text = dump::text(&plan);
                text.lines().filter(|line| !line.starts_with("  effect `")).map(String::from).collect::<Vec<_>>()
            })
        };
        assert_eq!(plan(frame.graph())?, plan(&graph)?);
    }
    Ok(())
}
