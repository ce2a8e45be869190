//! Renderables: groups, blocks and updates.

use super::*;
use crate::material::Material;
use crate::{MaterialId, MeshId};
use glam::DMat4;

fn placed(mesh: usize, material: usize, world_from_model: DMat4) -> Instance {
    let cube = Aabb { min: DVec3::NEG_ONE, max: DVec3::ONE };
    Instance::new("", MeshId::new(mesh), MaterialId::new(material), world_from_model, &cube)
}

fn scene() -> Scene {
    let mut scene = Scene { materials: vec![Material::default(); 2], ..Scene::default() };
    scene.materials.push(Material { alpha: AlphaMode::Mask { cutoff: 0.5 }, ..Material::default() });
    let at = |x: f64| DMat4::from_translation(DVec3::X * x);
    let mirrored = DMat4::from_scale(DVec3::new(-1.0, 1.0, 1.0));
    let flat = DMat4::from_scale(DVec3::new(5.0, 0.0, 5.0));
    let of = [(0, 0, at(0.0)), (0, 1, at(3.0)), (0, 0, at(6.0)), (1, 0, at(9.0)), (0, 0, mirrored), (0, 2, flat)];
    scene.instances.extend(of.map(|(mesh, material, at)| placed(mesh, material, at)));
    scene
}

/// Instances with the same mesh, material and winding are grouped; for depth the material of opaque ones is ignored.
#[test]
fn groups_have_in_common_what_draws_set() {
    let own = Renderables::new(&scene());
    let same = |groups: &Groups, a: usize, b: usize| groups.of[a] == groups.of[b];
    for (a, b, surface, depth) in
        [(0, 2, true, true), (0, 1, false, true), (0, 3, false, false), (0, 4, false, false), (0, 5, false, false)]
    {
        assert_eq!((same(own.surfaces(), a, b), same(own.depths(), a, b)), (surface, depth), "{a} {b}");
    }
    assert_eq!(own.kinds()[4..], [DrawKind::Opaque, DrawKind::Mask]);
    assert_eq!((own.flat(), own.solid_casters().max.x), (&[(5, 1)][..], 10.0));
}

/// Lines and points write depth, cast no shadows, and are not grouped with triangles.
#[test]
fn lines_and_points_do_not_cast() {
    let topologies = [Topology::Triangles, Topology::Lines, Topology::Points];
    let mesh = |topology| crate::Mesh { topology, ..crate::Mesh::default() };
    let mut scene = Scene { materials: vec![Material::default()], ..Scene::default() };
    scene.meshes.extend(topologies.map(mesh));
    let at = |mesh: usize| placed(mesh, 0, DMat4::from_translation(DVec3::X * (10.0 * mesh as f64)));
    scene.instances.extend([2, 1, 0].map(at));
    let own = Renderables::new(&scene);
    assert_eq!((own.casts(), own.kinds()), (&[false, false, true][..], &[DrawKind::Opaque; 3][..]));
    assert_eq!((own.solid_casters().max.x, own.whole().max.x), (1.0, 21.0));
    // Groups are sorted by topology, so each topology is drawn consecutively.
    assert_eq!((own.surfaces().of.as_slice(), own.depths().of.as_slice()), (&[2, 1, 0][..], &[2, 1, 0][..]));
}

/// Instances on hidden layers behave as if absent.
#[test]
fn hidden_instances_have_no_bounds_and_cast_nothing() {
    let mut scene = scene();
    let all = Renderables::new(&scene);
    assert!(matches!(all.shown(1), Cow::Borrowed(_)) && matches!(all.shown(255), Cow::Borrowed(_)));
    scene.instances[3].draw.layers = 6;
    scene.instances[5].draw.layers = 4;
    let all = Renderables::new(&scene);
    assert!(matches!(all.shown(5), Cow::Borrowed(_)), "every instance is in one of these layers");
    let shown = all.shown(1);
    let hidden = |number: &u32| [3, 5].contains(number);
    for number in 0..6 {
        assert_eq!(shown.bounds()[number as usize].is_empty(), hidden(&number), "{number}");
        assert_eq!(shown.casts()[number as usize], !hidden(&number), "{number}");
    }
    assert_eq!((shown.flat().len(), shown.whole().max.x), (0, 7.0));
    let mut seen = Vec::new();
    shown.boxes().reaching(DVec3::ZERO, &[DVec3::X.extend(1e3)], None, &mut seen);
    assert_eq!(seen, [0, 1, 2, 4]);
}

/// Instances with different light state are separate, except for depth.
#[test]
fn draw_options_keep_instances_apart() {
    let mut scene = scene();
    scene.instances[2].draw.light_channels = 2;
    let own = Renderables::new(&scene);
    assert_ne!(own.surfaces().of[0], own.surfaces().of[2]);
    assert_eq!((own.depths().of[0], own.common_light_channels()), (own.depths().of[2], 0));
    scene.instances[2].draw = DrawOptions { priority: 0, casts_shadows: false, ..DrawOptions::default() };
    let own = Renderables::new(&scene);
    assert_ne!(own.depths().of[0], own.depths().of[2]);
    assert_eq!((&own.casts()[..3], own.common_light_channels()), (&[true, true, false][..], 1));
}

/// Blocks are used entirely, in part or not at all.
#[test]
fn the_box_around_some_is_that_of_each() {
    let at = |i: usize| DMat4::from_translation(DVec3::new((i * 37 % 200) as f64, (i * 91 % 300) as f64, i as f64));
    let instances = (0..3 * BLOCK + 7).map(|i| placed(0, 0, at(i))).collect();
    let mut scene = Scene { materials: vec![Material::default()], instances, ..Scene::default() };
    let mut own = Renderables::new(&scene);
    for _ in 0..2 {
        let lists = [0..0, 0..3 * BLOCK + 7, 5..2 * BLOCK, BLOCK..2 * BLOCK, BLOCK + 1..2 * BLOCK];
        let lists = lists.map(|range| range.map(|i| i as u32).collect::<Vec<_>>());
        for list in lists.into_iter().chain([(0..150).filter(|i| i % 3 > 0).collect()]) {
            let each: Vec<Aabb> = list.iter().map(|i| own.bounds()[*i as usize]).collect();
            assert_eq!(own.around(&list), around(&each), "{list:?}");
        }
        assert!(own.rows().all(|(first, row, own)| *own == around(row) && first.is_multiple_of(BLOCK as u32)));
        assert_eq!(own.rows().map(|(_, row, _)| row.len()).collect::<Vec<_>>(), [BLOCK, BLOCK, BLOCK, 7]);
        scene.instances[BLOCK + 9] = placed(0, 0, at(5000));
        own.update(&scene, &[BLOCK + 9]);
    }
}

/// An update gives the result of building anew.
#[test]
fn an_update_is_as_making_anew() {
    let mut scene = scene();
    let mut own = Renderables::new(&scene);
    for to in [DMat4::from_translation(DVec3::Y * 40.0), DMat4::from_scale(DVec3::new(1.0, 1.0, -1.0))] {
        scene.instances[1] = placed(0, 1, to);
        own.update(&scene, &[1]);
        let anew = Renderables::new(&scene);
        assert_eq!((own.bounds(), own.flat(), &own.blocks), (anew.bounds(), anew.flat(), &anew.blocks));
        assert_eq!((own.surfaces(), own.depths()), (anew.surfaces(), anew.depths()));
        assert_eq!((own.whole(), own.solid_casters()), (anew.whole(), anew.solid_casters()));
    }
    assert_eq!(own.whole(), scene.bounds());
}
