//! Skinned and morphed characters, compared at five times with a separate implementation of the specification's
//! formulas in f64 arrays.

mod math;
mod model;
mod oracle;
mod shapes;

use std::path::Path as FilePath;

use self::math::{IDENTITY, Matrix, Noise, Vector, length, of_parts, product, rounded, turn};
use self::model::{Character, Code, Drawn, Local, Node, Path, Skin, Way};
use self::shapes::{TIMES, animate, at_origin, biped, chain, channel, draw, ignored, morph, shape};
use crate::import::load_bytes_with;
use crate::progress::silent;
use crate::{LoadOptions, Scene};
use glam::{DMat3, DVec3};

fn loaded(character: &Character) -> Scene {
    // Keeps the file order, so that vertices can be identified.
    let options = LoadOptions { keep_order: true, ..LoadOptions::default() };
    let bytes = character.file().glb();
    let scene = load_bytes_with(FilePath::new("c.glb"), &bytes, &options, &mut silent).expect("it is sound");
    assert_eq!(scene.warnings, [""; 0]);
    scene
}

/// Returns the largest differences of positions, relative to the size of the shape, and of normals, at rest and at all
/// times.
///
/// The crate computes in f64 and stores f32 relative to the first joint. The error of a position is 2⁻²⁴ of its
/// distance from there per axis, and as much for each weight. The tests allow forty times that, 2.4e-6, for positions,
/// and 1e-5 for normals, which stretching may magnify.
fn differences(character: &Character) -> [f64; 2] {
    let mut scene = loaded(character);
    let mut largest = [0.0_f64; 2];
    for time in [None].into_iter().chain(TIMES.map(Some)) {
        let animation = time.filter(|_| !character.channels.is_empty()).map(|_| 0);
        scene.pose(animation, time.unwrap_or_default()).expect("it can be posed");
        assert_eq!(scene.check(), Ok(()));
        let truth = oracle::posed(character, time.filter(|_| animation.is_some()));
        assert_eq!(scene.instances.len(), truth.len());
        for (number, truth) in truth.iter().enumerate() {
            let name = format!("drawn {number}");
            let instance = scene.instances.iter().find(|instance| instance.name == name).expect("it is drawn");
            let (mesh, world) = (&scene.meshes[instance.mesh.index()], instance.world_from_model);
            assert_eq!(mesh.positions.len(), truth.positions.len());
            assert_eq!(instance.is_mirrored(), truth.is_mirrored, "{time:?} {name}");
            let size = truth.positions.iter().map(|p| length(&minus(*p, truth.positions[0]))).fold(0.0, f64::max);
            let turn = DMat3::from_mat4(world).inverse().transpose();
            for vertex in 0..truth.positions.len() {
                let position = world.transform_point3(mesh.positions[vertex].as_dvec3());
                let normal = (turn * mesh.normals[vertex].as_dvec3()).normalize();
                assert!(instance.bounds.min.cmple(position + DVec3::splat(1e-5 * size)).all(), "{name}");
                assert!(instance.bounds.max.cmpge(position - DVec3::splat(1e-5 * size)).all(), "{name}");
                let off = [
                    length(&minus(position.to_array(), truth.positions[vertex])) / size,
                    length(&minus(normal.to_array(), truth.normals[vertex])),
                ];
                largest = [0, 1].map(|i| if off[i].is_nan() { f64::INFINITY } else { largest[i].max(off[i]) });
            }
        }
    }
    largest
}

fn minus(a: Vector, b: Vector) -> Vector {
    std::array::from_fn(|axis| a[axis] - b[axis])
}

#[track_caller]
fn compare(character: &Character) {
    let [positions, normals] = differences(character);
    assert!(positions < 2.4e-6 && normals < 1e-5, "{positions:e} {normals:e}");
}

/// An animated biped with a skin, drawn with one set of weights.
fn plain_biped() -> Character {
    let mut noise = Noise(1);
    let mut character = Character::default();
    let joints = biped(&mut noise, 1.0);
    let nodes = joints.add(&mut character, None);
    let skin = Skin { joints: nodes.clone(), inverse_bind: Some(joints.inverse_bind(&IDENTITY)), skeleton: None };
    let shape = shape(&mut noise, &joints, &IDENTITY, 1.0, 1, Code::F32);
    draw(&mut character, shape, Some(skin), None, at_origin());
    animate(&mut noise, &mut character, &nodes);
    character
}

#[test]
fn a_biped_whose_bind_pose_is_not_its_rest_pose() {
    let character = plain_biped();
    compare(&character);
    // Ensures that the animation and the bind pose have an effect.
    let first = |time| oracle::posed(&character, time)[0].positions[0];
    assert!(length(&minus(first(None), first(Some(1.0)))) > 0.01);
    assert!(length(&minus(first(None), character.shapes[0].positions[0])) > 0.01);
}

/// One inverse bind matrix is off by a millimeter, one normal by a degree: neither may pass.
#[test]
fn the_comparison_notices_a_millimeter() {
    let truth = plain_biped();
    let mut wrong = truth.clone();
    wrong.skins[0].inverse_bind.as_mut().expect("it has some")[4][3][0] += 0.001;
    let posed = |character: &Character| oracle::posed(character, Some(1.0));
    let mut scene = loaded(&wrong);
    scene.pose(Some(0), 1.0).expect("it can be posed");
    let (instance, mesh) = (&scene.instances[0], &scene.meshes[0]);
    let off = |truth: &Character| {
        let truth = &posed(truth)[0].positions;
        let distance = |vertex: usize| {
            let place = instance.world_from_model.transform_point3(mesh.positions[vertex].as_dvec3());
            length(&minus(place.to_array(), truth[vertex]))
        };
        (0..truth.len()).map(distance).fold(0.0, f64::max)
    };
    assert!(off(&wrong) < 1e-5);
    assert!(off(&truth) > 1e-4, "{}", off(&truth));
    // Channels that are compared with each other fail too.
    let mut other = truth.clone();
    other.channels[1].values[5] += 0.1;
    let mut scene = loaded(&other);
    scene.pose(Some(0), 1.0).expect("it can be posed");
    let place = scene.instances[0].world_from_model.transform_point3(scene.meshes[0].positions[0].as_dvec3());
    assert!(length(&minus(place.to_array(), posed(&truth)[0].positions[0])) > 1e-4);
}

/// Blender's FBX export: joints in centimeters below a node of scale 0.01, rotated by −90° about x. The mesh's node is
/// its child or its sibling, and has a transform.
#[test]
fn a_biped_below_an_armature_in_centimeters() {
    for is_child in [true, false] {
        let mut noise = Noise(2);
        let mut character = Character::default();
        let parts =
            ([0.5, 0.0, -2.0], turn([1.0, 0.0, 0.0], -std::f64::consts::FRAC_PI_2).map(rounded), [rounded(0.01); 3]);
        character.nodes.push(Node { parent: None, local: Local::Parts(parts.0, parts.1, parts.2) });
        let joints = biped(&mut noise, 100.0);
        let nodes = joints.add(&mut character, Some(0));
        // The mesh in meters, with y up, where the armature places it.
        let (to_mesh, to_joints) = if is_child {
            (IDENTITY, IDENTITY)
        } else {
            let armature = of_parts(parts.0, parts.1, parts.2);
            (armature, math::inverse(&armature))
        };
        let shape = shape(&mut noise, &joints, &to_mesh, 100.0, 1, Code::F32);
        let inverse_bind = joints.inverse_bind(&to_joints);
        let skin = Skin { joints: nodes.clone(), inverse_bind: Some(inverse_bind), skeleton: None };
        let local = ignored(&mut noise);
        draw(&mut character, shape, Some(skin), is_child.then_some(0), local);
        animate(&mut noise, &mut character, &nodes);
        compare(&character);
    }
}

/// Two sets of weights, as floats, bytes and 16-bit integers, with 8-bit and 16-bit joints.
#[test]
fn eight_influences_in_every_encoding() {
    for weights in [Code::F32, Code::U8, Code::U16] {
        let mut noise = Noise(3);
        let mut character = Character::default();
        let joints = biped(&mut noise, 1.0);
        let nodes = joints.add(&mut character, None);
        let skin = Skin { joints: nodes.clone(), inverse_bind: Some(joints.inverse_bind(&IDENTITY)), skeleton: None };
        let shape = shape(&mut noise, &joints, &IDENTITY, 1.0, 2, weights);
        draw(&mut character, shape, Some(skin), None, at_origin());
        animate(&mut noise, &mut character, &nodes);
        compare(&character);
        // The second set must have an effect.
        let mut without = character.clone();
        without.shapes[0].influences.pop();
        let place = |character: &Character| oracle::posed(character, Some(1.0))[0].positions[3];
        assert!(length(&minus(place(&without), place(&character))) > 1e-3);
    }
}

/// Targets are added before joints move the vertex, with weights at rest and with each interpolation.
#[test]
fn morph_targets_with_normals_below_a_skin_and_without_one() {
    for (way, code) in [(Way::Step, Code::F32), (Way::Linear, Code::U8), (Way::Cubic, Code::F32)] {
        for is_skinned in [true, false] {
            let mut noise = Noise(4);
            let mut character = Character::default();
            let joints = biped(&mut noise, 1.0);
            let nodes = joints.add(&mut character, None);
            let inverse_bind = Some(joints.inverse_bind(&IDENTITY));
            let skin = is_skinned.then(|| Skin { joints: nodes.clone(), inverse_bind, skeleton: None });
            let mut shape = shape(&mut noise, &joints, &IDENTITY, 1.0, usize::from(is_skinned), Code::F32);
            morph(&mut noise, &mut shape, 0.2);
            let local = ignored(&mut noise);
            draw(&mut character, shape, skin, Some(nodes[1]), local);
            animate(&mut noise, &mut character, &nodes);
            let node = character.drawn[0].node;
            let weights = |noise: &mut Noise| vec![noise.number().abs(), noise.number().abs()];
            character.channels.push(channel(&mut noise, node, Path::Weights, way, code, &weights));
            compare(&character);
        }
    }
}

/// Two meshes share a skin; another skin has some of its joints in another order with other binds.
#[test]
fn meshes_share_skins_and_skins_share_joints() {
    let mut noise = Noise(5);
    let mut character = Character::default();
    let joints = biped(&mut noise, 1.0);
    let nodes = joints.add(&mut character, None);
    let skin = Skin { joints: nodes.clone(), inverse_bind: Some(joints.inverse_bind(&IDENTITY)), skeleton: None };
    for _ in 0..2 {
        let own = shape(&mut noise, &joints, &IDENTITY, 1.0, 1, Code::F32);
        let local = ignored(&mut noise);
        draw(&mut character, own, None, None, local);
        character.drawn.last_mut().expect("it was added").skin = Some(0);
    }
    character.skins.push(skin);
    // Five joints from the end, bound with an offset of 0.3 m and renumbered.
    let aside: Matrix = of_parts([rounded(0.3), 0.0, 0.0], [0.0, 0.0, 0.0, 1.0], [1.0; 3]);
    let binds = joints.inverse_bind(&aside);
    let few: Vec<usize> = (6..11).rev().collect();
    let mut own = shape(&mut noise, &joints, &IDENTITY, 1.0, 1, Code::F32);
    own.influences[0].joints.iter_mut().flatten().for_each(|joint| *joint %= 5);
    let skin = Skin {
        joints: few.iter().map(|joint| nodes[*joint]).collect(),
        inverse_bind: Some(few.iter().map(|joint| binds[*joint]).collect()),
        skeleton: None,
    };
    draw(&mut character, own, Some(skin), None, at_origin());
    // The same shape again, on another node with another skin.
    character.nodes.push(Node { parent: None, local: at_origin() });
    let node = character.nodes.len() - 1;
    character.drawn.push(Drawn { node, shape: 2, skin: Some(0) });
    animate(&mut noise, &mut character, &nodes);
    compare(&character);
}

#[test]
fn a_chain_of_three_hundred_joints() {
    let mut noise = Noise(6);
    let mut character = Character::default();
    let joints = chain(&mut noise, 300);
    let nodes = joints.add(&mut character, None);
    let skin = Skin { joints: nodes.clone(), inverse_bind: Some(joints.inverse_bind(&IDENTITY)), skeleton: None };
    let mut shape = shape(&mut noise, &joints, &IDENTITY, 1.0, 1, Code::F32);
    // A subset of vertices is enough, including the last joints.
    let keep = |vertex: &usize| vertex % 60 < 3 || *vertex >= 1794;
    let kept: Vec<usize> = (0..1800).filter(keep).collect();
    shape.positions = kept.iter().map(|vertex| shape.positions[*vertex]).collect();
    shape.normals = kept.iter().map(|vertex| shape.normals[*vertex]).collect();
    let set = &mut shape.influences[0];
    set.joints = kept.iter().map(|vertex| set.joints[*vertex]).collect();
    set.weights = kept.iter().map(|vertex| set.weights[*vertex]).collect();
    assert!(set.joints.iter().flatten().any(|joint| *joint > 290));
    draw(&mut character, shape, Some(skin), None, at_origin());
    // Scales of 300 joints would accumulate.
    character.nodes.iter_mut().for_each(|node| {
        if let Local::Parts(t, r, _) = node.local {
            node.local = Local::Parts(t, r, [1.0; 3]);
        }
    });
    animate(&mut noise, &mut character, &nodes);
    character.channels.retain(|channel| channel.path == Path::Rotation && channel.node % 10 == 0);
    compare(&character);
}

/// Joints below a node with a matrix, in an animated hierarchy outside of the default scene, with `skeleton`.
#[test]
fn joints_outside_of_the_scene_and_a_skeleton_root() {
    let mut noise = Noise(7);
    let mut character = Character::default();
    let above = of_parts(noise.vector(2.0), noise.rotation(2.0), [1.5; 3]);
    let above = Local::Matrix(above.map(|column| column.map(rounded)));
    character.nodes.push(Node { parent: None, local: above });
    let joints = biped(&mut noise, 1.0);
    let nodes = joints.add(&mut character, Some(0));
    let inverse_bind = Some(joints.inverse_bind(&IDENTITY));
    let skin = Skin { joints: nodes.clone(), inverse_bind, skeleton: Some(nodes[0]) };
    let shape = shape(&mut noise, &joints, &IDENTITY, 1.0, 1, Code::F32);
    let local = ignored(&mut noise);
    draw(&mut character, shape, Some(skin), None, local);
    animate(&mut noise, &mut character, &nodes);
    compare(&character);
    character.outside = vec![0];
    let scene = character.file().load().expect("it is sound");
    assert_eq!(scene.warnings.len(), 1, "{:?}", scene.warnings);
    assert!(scene.warnings[0].contains("skin 0: joints outside of the scene"), "{:?}", scene.warnings);
    compare_with_warning(&character);
}

/// Runs [`compare`] for a character whose file causes warnings.
fn compare_with_warning(character: &Character) {
    let mut inside = character.clone();
    inside.outside.clear();
    let options = LoadOptions { keep_order: true, ..LoadOptions::default() };
    let bytes = character.file().glb();
    let mut scene = load_bytes_with(FilePath::new("c.glb"), &bytes, &options, &mut silent).expect("it is sound");
    let mut same = loaded(&inside);
    for time in TIMES {
        scene.pose(Some(0), time).expect("it can be posed");
        same.pose(Some(0), time).expect("it can be posed");
        assert_eq!(scene.meshes, same.meshes);
        assert_eq!(scene.instances, same.instances);
    }
}

/// A node's own weights override those of its mesh.
#[test]
fn weights_of_a_node_replace_those_of_its_mesh() {
    let mut noise = Noise(10);
    let mut character = Character::default();
    let joints = biped(&mut noise, 1.0);
    let mut shape = shape(&mut noise, &joints, &IDENTITY, 1.0, 0, Code::F32);
    morph(&mut noise, &mut shape, 0.2);
    draw(&mut character, shape, None, None, at_origin());
    let mut of_node = character.file();
    of_node.set("/nodes/0/weights", serde_json::json!([0.5, 0.75]));
    character.shapes[0].morph_weights = vec![0.5, 0.75];
    assert_eq!(of_node.load().expect("it is sound").meshes, character.file().load().expect("it is sound").meshes);
    compare(&character);
}

/// Without inverse bind matrices, joints transform vertices from their positions; precision is kept far from the
/// origin.
#[test]
fn without_inverse_bind_matrices_and_far_away() {
    let mut noise = Noise(8);
    let mut character = Character::default();
    character.nodes.push(Node { parent: None, local: Local::Parts([1e6, 0.0, -2e6], [0.0, 0.0, 0.0, 1.0], [1.0; 3]) });
    let joints = biped(&mut noise, 1.0);
    let nodes = joints.add(&mut character, Some(0));
    let skin = Skin { joints: nodes.clone(), inverse_bind: None, skeleton: None };
    let shape = shape(&mut noise, &joints, &IDENTITY, 1.0, 1, Code::F32);
    draw(&mut character, shape, Some(skin), None, at_origin());
    animate(&mut noise, &mut character, &nodes);
    compare(&character);
}

/// A negative scale above the joints mirrors the character: triangles wind clockwise, as for any mirrored node.
#[test]
fn a_mirrored_armature_mirrors_the_instance() {
    let mut noise = Noise(9);
    let mut character = Character::default();
    let local = Local::Parts([1.0, 2.0, 3.0], [0.0, 0.0, 0.0, 1.0], [-1.0, 1.0, 1.0]);
    character.nodes.push(Node { parent: None, local });
    let joints = biped(&mut noise, 1.0);
    let nodes = joints.add(&mut character, Some(0));
    let skin = Skin { joints: nodes.clone(), inverse_bind: Some(joints.inverse_bind(&IDENTITY)), skeleton: None };
    let shape = shape(&mut noise, &joints, &IDENTITY, 1.0, 1, Code::F32);
    draw(&mut character, shape, Some(skin), Some(0), at_origin());
    animate(&mut noise, &mut character, &nodes);
    assert!(oracle::posed(&character, None)[0].is_mirrored);
    compare(&character);
}

/// Two primitives of a skinned mesh with equal geometry and different materials both follow the joints.
#[test]
fn primitives_with_equal_geometry_both_follow_the_joints() {
    let character = plain_biped();
    let mut file = character.file();
    let mut second = file.json["meshes"][0]["primitives"][0].clone();
    second["material"] = serde_json::json!(0);
    file.push("materials", serde_json::json!({}));
    file.primitive(second);
    let mut scene = file.load().expect("it is sound");
    scene.pose(Some(0), 1.0).expect("it can be posed");
    let [first, second] = &scene.instances[..] else { panic!("{} instances", scene.instances.len()) };
    assert_eq!(first.bounds, second.bounds);
    assert_eq!(first.world_from_model, second.world_from_model);
}

/// Checks the oracle itself on known values.
#[test]
fn the_oracle_knows_its_mathematics() {
    let quarter = turn([0.0, 0.0, 1.0], std::f64::consts::FRAC_PI_2);
    let matrix = of_parts([1.0, 2.0, 3.0], quarter, [2.0, 3.0, 4.0]);
    let close = |a: Vector, b: Vector| assert!(length(&minus(a, b)) < 1e-12, "{a:?} {b:?}");
    close(math::point(&matrix, [1.0, 1.0, 1.0]), [-2.0, 4.0, 7.0]);
    // The plane x + y = 0 of the cube stretched by 2 and 3: its normal is (1/2, 1/3) before rotation.
    close(math::normal(&matrix, [1.0, 1.0, 0.0]), math::unit([-1.0 / 3.0, 0.5, 0.0]));
    let same = product(&matrix, &math::inverse(&matrix));
    assert!(same.as_flattened().iter().zip(IDENTITY.as_flattened()).all(|(a, b)| (a - b).abs() < 1e-12));
    let half = math::slerp([0.0, 0.0, 0.0, 1.0], quarter.map(|x| -x), 0.5);
    assert!((half[2].abs() - (std::f64::consts::PI / 8.0).sin()).abs() < 1e-12, "{half:?}");
}
