#!/bin/sh
# Plays `render` for tests: the first word of the scene file says how it ends.
# $1 is the scene; the picture goes to the argument after --out.
scene=$1
until [ "$1" = --out ]; do shift; done
echo "rendered" >> "$scene.count"
picture() {
    cp "$(dirname "$scene")/picture" "$1"
    echo "wrote h.png: hdr@color, 64x64 Rgba16Float, 0 to 1$2"
}
case $(head -c 6 "$scene") in
    good*) picture "$2" ;;
    warned) picture "$2"; echo "warning: a.gltf: lines are not drawn" >&2 ;;
    nan*) picture "$2" ", 3 texels not finite" ;;
    unseen) picture "$2" >/dev/null ;;
    absent) ;;
    refuse) echo "reading files: 1" >&2; echo "error: a.gltf: JSON: it is cut off" >&2; exit 2 ;;
    device) echo "error: the device is lost" >&2; exit 1 ;;
    panic*) printf '\nthread main panicked at src/a.rs:1:2:\nindex out of bounds\nnote: run with\n' >&2; exit 101 ;;
    silent) exit 2 ;;
    crash*) kill -SEGV $$ ;;
    hang*) exec sleep 60 ;;
    eat*) exec tail /dev/zero ;;
esac
