#!/usr/bin/env bash
# Draws docs/look/sheet.png: candidates for the default look (rows) on six scenes (columns).
# Needs ImageMagick. Usage: docs/look/sheet.sh [path of sdfc]
set -eu
sdfc=${1:-sdfc}
here=$(cd "$(dirname "$0")" && pwd)
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

blend='union(sphere(0.9).translate(y: 0.6), box([1.6, 1, 1.6]), blend: smooth(0.4)).color(#d94f30)'
scenes=(
  'sphere(1)'
  'box(1.6).round(0.05)'
  "$blend"
  "$blend
plane(y: -0.5)"
  'sphere(0.5).color(#2f6f9f).translate([-1.2, 0.5, 0])
box(0.9).rotate(y: 30deg).translate([0, 0.45, 0.2]).color(#e9b44c)
torus(0.4, 0.16).translate([1.2, 0.16, 0.1]).color(#7a9e4f)
cylinder(h: 1.6, r: 0.3).translate([0.7, 0.8, -0.9]).color(#f2efe9)
plane()'
  'sphere(0.7).color(#d4af37).metallic(1).roughness(0.3)
plane(y: -0.7).color(#88909c)'
)
occlusion='ambient_occlusion()'
looks=(
  "$(grep -v '^//' "$here/../../crates/lang/std/look.sdf")"
  'sun(direction: [-0.7, 1.1, 0.9], color: #fff1dc, strength: 0.8, shadow: soft(6))
sun(direction: [1, 0.3, 0.4], color: #a9c4ff, strength: 0.15)
ambient(#dbe6ff, 0.3)
sky(zenith: #7f9cc4, horizon: #f4efe8, ground: #b9b6b3)
exposure()'
  'sun(direction: [-0.6, 1.3, 0.8], color: #fff4e6, strength: 0.75, shadow: soft(4))
sun(direction: [1, 0.5, 0.3], color: #cfdcff, strength: 0.2)
ambient(#eef2ff, 0.3)
sky(zenith: #eceff4, horizon: #ffffff, ground: #c4c8cf)
exposure()'
  'sun(direction: [-1, 0.8, 0.7], color: #ffdcb0, shadow: soft(6))
sun(direction: [1, 0.6, 0.2], color: #8fb2ff, strength: 0.3)
ambient(#b9c8ff, 0.22)
sky(zenith: #3f5f97, horizon: #f0d9c8, ground: #6d6a78)
exposure(tone: "film")'
  'sun(direction: [-0.7, 1.2, 0.8], color: #fff0dc, strength: 0.95, shadow: soft(6))
sun(direction: [1, 0.2, -0.6], color: #9dbcff, strength: 0.35)
ambient(#cfdcff, 0.22)
sky(zenith: #1d2836, horizon: #8fa0b4, ground: #2b3542)
exposure()'
  'sun(direction: [-0.8, 1.2, 0.9], color: #ffead2, strength: 1.15, shadow: soft(4))
sun(direction: [1, 0.3, 0.2], color: #a5c2ff, strength: 0.18)
ambient(#d2deff, 0.32)
sky(zenith: #86a3cc, horizon: #f6efe6, ground: #b5ada3)
exposure()'
  'sun(direction: [0.5, 0.45, 1])'
)
pictures=()
for look in "${looks[@]}"; do
  [[ "$look" == *"$occlusion"* || "$look" != *ambient* ]] || look+=$'\n'"$occlusion"
  for scene in "${scenes[@]}"; do
    picture=$work/${#pictures[@]}.png
    printf '%s\n%s\n' "$scene" "$look" | "$sdfc" render - -o "$picture" --size 144x108 --samples 4 -q
    pictures+=("$picture")
  done
done
montage "${pictures[@]}" -tile "${#scenes[@]}x" -geometry +1+1 "$here/sheet.png"
