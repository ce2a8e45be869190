//! A wall of cards: a card for each material and angle of view.
//!
//! Cards face a parallel camera, but their vertex normals lean away from it, so each is shaded at one angle exactly.

use super::board::{Board, Seen, card};
use framegraph_passes::Shading;
use framegraph_scene::{Environment, Light, Material, Scene};
use framegraph_wgpu::Gpu;
use glam::{DMat4, DVec3};
use std::error::Error;

/// A surface and how it is seen.
#[derive(Clone, Debug)]
pub struct Card {
    /// The surface.
    pub material: Material,
    /// n·v, above 0: the normal leans toward +x.
    pub nov: f64,
}

/// The scene: its first textures may be used by materials.
#[derive(Clone, Debug, Default)]
pub struct Wall {
    /// Textures that the cards' materials name; nothing else.
    pub scene: Scene,
    /// The cards.
    pub cards: Vec<Card>,
    /// What lights them directly.
    pub light: Option<Light>,
}

impl Wall {
    /// Renders the wall under `environment`; the cards in their order, and last what is seen beside them, which is the
    /// environment. One nit is shown as 0.5.
    ///
    /// # Errors
    /// What the device refuses.
    pub fn render(&self, gpu: &Gpu, environment: &Environment, shading: &Shading) -> Result<Vec<Seen>, Box<dyn Error>> {
        let mut board = Board { scene: self.scene.clone(), ..Board::default() };
        for Card { material, nov } in &self.cards {
            let sin = (1.0 - nov * nov).max(0.0).sqrt();
            let leaning = card(1.0, DVec3::new(sin, 0.0, *nov), DVec3::new(*nov, 0.0, -sin), 1.0);
            board.hang(material.clone(), leaning, DMat4::IDENTITY);
        }
        board.scene.lights.extend(self.light.clone());
        board.render(gpu, environment, shading)
    }
}
