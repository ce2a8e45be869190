//! Temporal errors of made-up sequences.

use tests::lab::temporal::temporal;
use tests::reference::picture::Picture;

/// Returns eight frames in which a bright column moves right by one pixel each.
fn film(value: impl Fn(usize, usize, f32) -> f32) -> Vec<Picture> {
    let frame = |frame: usize| {
        let pixel = |at: usize| [value(frame, at, if at % 16 == frame { 1.0 } else { 0.25 }); 3];
        let encoded: Vec<_> = (0..256).map(pixel).collect();
        Picture { size_px: [16, 16], linear: encoded.clone(), encoded }
    };
    (0..8).map(frame).collect()
}

#[test]
fn each_temporal_error_is_found_in_its_own_sequence() -> Result<(), Box<dyn std::error::Error>> {
    let truth = film(|_, _, own| own);
    let of = |film: &[Picture]| temporal(film, &truth);
    let none = of(&truth)?;
    assert_eq!((none.spatial, none.flicker, none.ghost, none.pop), (0.0, 0.0, 0.0, 1.0));
    let offset = of(&film(|_, _, own| own - 0.04))?;
    assert!(offset.spatial > 10.0 && offset.flicker < 0.1 && offset.pop == 1.0, "a constant error: {offset:?}");
    let flicker = of(&film(|frame, _, own| own + if frame % 2 == 0 { 0.02 } else { 0.0 }))?;
    assert!(flicker.flicker > 5.0 && flicker.pop < 1.2, "{flicker:?}");
    let trail = |frame: usize, at: usize, own: f32| if frame > 0 && at % 16 == frame - 1 { 0.5 } else { own };
    let ghost = of(&film(trail))?;
    assert!(ghost.ghost > 0.15 && flicker.ghost < 0.05, "a third of the old value is left: {ghost:?}");
    let pop = of(&film(|frame, at, own| own + if frame >= 4 && at < 128 { 0.1 } else { 0.0 }))?;
    assert!(pop.pop > 10.0, "{pop:?}");
    assert!(temporal(&truth[..2], &truth[..2]).is_err());
    Ok(())
}
