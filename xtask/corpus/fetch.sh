#!/bin/sh
# Fetches packages that contain glTF files: fetch.sh FOLDER
# Needs npm, pip, unzip, cargo, and apt-get with source packages of Debian 12; takes 800 MB.
set -eu
mkdir -p "$1"
cd "$1"

mkdir -p npm && (
    cd npm
    npm pack --silent @webxr-input-profiles/assets@1.0.20 >/dev/null
    for file in *.tgz; do tar xzf "$file"; done
    rm ./*.tgz
)
mkdir -p pypi && (
    cd pypi
    pip download --quiet --no-deps genesis-world==1.4.5 mani-skill==3.0.1 gradio==6.31.0
    for file in *.whl; do unzip -qo "$file" -d "${file%%-*}"; done
    rm ./*.whl
)
mkdir -p debian && (
    cd debian
    apt-get source --download-only assimp=5.2.5~ds0-1 draco=1.5.5+dfsg-2 tinygltf=2.7.0+dfsg-2
    for file in *.orig.tar.xz; do tar xJf "$file"; done
    rm ./*.tar.xz ./*.dsc
)
mkdir -p crates/src && (
    cd crates
    printf '[package]\nname = "files"\nversion = "0.0.0"\nedition = "2021"\n[dependencies]\neasy-gltf = "=1.1.5"\ngltf-json = "=1.4.1"\n' >Cargo.toml
    touch src/lib.rs
    cargo vendor --quiet >/dev/null
)
find . -iname '*.gltf' -o -iname '*.glb' | wc -l
