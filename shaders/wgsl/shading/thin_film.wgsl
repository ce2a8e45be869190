// The thin film of a fragment.

@if(IRIDESCENCE)
import package::interface::iridescence::iridescence;
@if(IRIDESCENCE)
import package::interface::material::material;
import package::lib::real::real3;
@if(IRIDESCENCE)
import package::shading::surface::{ThinFilm, film_reflectance, largest_channel};

/// Returns the thin film of a fragment over a base whose f0 is `bare_f0`. `dielectric` is the
/// dielectric reflectance at normal incidence and, in w, at grazing incidence; `color` is the
/// metal's.
@if(IRIDESCENCE)
fn film_of(
    uv: vec4<f32>,
    nov: f32,
    bare_f0: real3,
    color: vec3<f32>,
    metallic: f32,
    dielectric: vec4<f32>,
) -> ThinFilm {
    let values = iridescence(uv);
    // The weight applies to the film's reflectance as a whole, not to the base below.
    let unweakened = min(dielectric.rgb / max(dielectric.w, 1e-4), vec3<f32>(1.0));
    var film = ThinFilm(
        // A film of zero thickness has no effect, so films thinner than an atom fade out.
        saturate(values.x) * smoothstep(0.0, 0.03, values.y),
        material.iridescence.ior,
        values.y,
        mix(unweakened, saturate(color), metallic),
        mix(dielectric.w, 1.0, metallic),
        bare_f0,
        0.0,
    );
    film.toward_view = film.factor * largest_channel(film_reflectance(film, nov));
    return film;
}
