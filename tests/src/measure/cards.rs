//! A grid of cards: one for each material and angle of view.
//!
//! Cards face a parallel camera, but their vertex normals are tilted, so each is shaded at exactly one angle.

use super::board::{Board, Seen, card};
use framegraph_passes::Shading;
use framegraph_scene::{Environment, Light, Material, Scene};
use framegraph_wgpu::Gpu;
use glam::{DMat4, DVec3};
use std::error::Error;

/// A surface with its angle of view.
#[derive(Clone, Debug)]
pub struct Card {
    /// Material of the surface.
    pub material: Material,
    /// n·v, above 0: the normal tilts toward +x.
    pub nov: f64,
}

/// A grid of cards, with a scene whose textures the materials may use.
#[derive(Clone, Debug, Default)]
pub struct Wall {
    /// Scene with the textures of the cards' materials, and nothing else.
    pub scene: Scene,
    /// The cards.
    pub cards: Vec<Card>,
    /// Direct light, if any.
    pub light: Option<Light>,
}

impl Wall {
    /// Renders the wall under `environment`. Returns the cards in order, then the background, which is the environment.
    /// One nit is displayed as 0.5.
    ///
    /// # Errors
    /// The device fails.
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
