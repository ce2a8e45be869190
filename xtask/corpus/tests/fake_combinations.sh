#!/bin/sh
# Plays `render` for combinations: options in the command line say how it ends.
case " $* " in
    *" --precision f16 "*) echo "error: --precision f16: this adapter has no half floats" >&2; exit 2 ;;
    *" --fog on "*) kill -SEGV $$ ;;
    *" --dof on "*) radiance=", 3 texels not finite" ;;
    *" --ssr on "*) echo "error: validation: a texture is bound twice" >&2; exit 1 ;;
esac
until [ "$1" = --out ]; do shift; done
echo picture > "$2"
echo "wrote h.png: hdr@color, 64x48 Rgba16Float, 0 to 1$radiance"
