#!/bin/bash
# Tests packaging/farm/openjd: checks the templates with the tools of Open Job Description, runs a
# job of 24 frames and a picture in bands, and compares the files with those that one process draws.
#
# It needs openjd-cli from PyPI, for example in a virtual environment:
#
#   python3 -m venv venv && venv/bin/pip install openjd-cli
#   PATH="$PWD/venv/bin:$PATH" tests/farm/openjd.sh target/debug/sdfc
set -euo pipefail

sdfc=$(realpath "${1:?the program sdfc}")
here=$(cd "$(dirname "$0")" && pwd)
templates=$(realpath "$here/../../packaging/farm/openjd")
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"
mkdir alone frames picture
cp "$here/scene.sdf" .

for template in frames picture; do
  openjd check "$templates/$template.yaml"
done

run() {
  openjd run "$@" --job-param "Program=$sdfc" --job-param "Scene=$work/scene.sdf" \
    --job-param Device=cpu > log 2>&1 || { cat log >&2; exit 1; }
}

"$sdfc" render scene.sdf --frames 0..24 --size 96x54 --backend cpu --output alone/frame.exr
run "$templates/frames.yaml" --step Frames --job-param "OutputFolder=$work/frames" \
  --job-param OutputName=frame.exr --job-param FramesPerTask=5 --job-param Size=96x54
diff -r -x 'large.*' alone frames
echo "24 frames in $(grep -c 'Running Task' log) tasks are identical"

"$sdfc" render scene.sdf --size 640x360 --backend cpu --output alone/large.png
run "$templates/picture.yaml" --step Join --run-dependencies \
  --job-param "OutputFolder=$work/picture" --job-param OutputName=large --job-param Size=640x360
cmp alone/large.png picture/large.png
echo "a picture in $(find picture -name 'large.part-*.png' | wc -l) bands is identical"
