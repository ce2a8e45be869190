"""Times a frame of Filament from Open3D for `cargo xtask bench --frames --beside`.

    python3 frame.py SCENE.glb 1280x720 3.2,2.6,4.6 -0.2,0.7,-0.4

The scene, the size, where the eye is and what it looks at, in m. Sun with a PCF shadow, image light, post-processing and FXAA, one
sample. A frame is read back, which is not drawing: so the median of an empty frame without shadows and post-processing, in a
process of its own, is taken off that of the scene's, and what is left is printed last, in ms.
"""

import statistics
import subprocess
import sys
import time

import open3d
from open3d.visualization import rendering

WARMING_UP, FRAMES = 2, 12


def median_ms(path, size, eye, target):
    """Returns the median time of a frame with readback; of an empty frame if the path is empty."""
    renderer = rendering.OffscreenRenderer(*size)
    shown, view = renderer.scene, renderer.scene.view
    if path:
        shown.add_model("scene", open3d.io.read_triangle_model(path))
    shown.set_background([0.3, 0.4, 0.6, 1.0])
    view.set_sample_count(1)
    view.set_post_processing(bool(path))
    view.set_antialiasing(bool(path), False)
    view.set_ambient_occlusion(False, False)
    view.set_shadowing(bool(path), rendering.View.ShadowType.PCF)
    shown.scene.enable_sun_light(True)
    shown.scene.set_sun_light([-0.5, -0.8, -0.3], [1.0, 1.0, 1.0], 100000)
    shown.scene.enable_indirect_light(True)
    shown.scene.set_indirect_light_intensity(20000)
    shown.camera.look_at(target, eye, [0.0, 1.0, 0.0])
    shown.camera.set_projection(45.0, size[0] / size[1], 0.1, 30.0, rendering.Camera.FovType.Vertical)
    times = []
    for _ in range(WARMING_UP + FRAMES):
        begin = time.perf_counter()
        renderer.render_to_image()
        times.append((time.perf_counter() - begin) * 1e3)
    return statistics.median(times[WARMING_UP:])


def main(path, size, eye, target):
    place = [[int(number) for number in size.split("x")]]
    place += [[float(number) for number in point.split(",")] for point in (eye, target)]
    time_ms = median_ms(path, *place)
    if not path:
        return print(time_ms)
    own = subprocess.run([sys.executable, __file__, "", size, eye, target], capture_output=True, text=True, check=True)
    empty_ms = float(own.stdout.split()[-1])
    print(f"with the scene {time_ms:.1f}, empty {empty_ms:.1f}, drawn {time_ms - empty_ms:.1f} ms")


if __name__ == "__main__":
    if len(sys.argv) != 5:
        sys.exit(__doc__)
    main(*sys.argv[1:])
