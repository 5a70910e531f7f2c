#!/usr/bin/env bash
# The pictures of the gallery's cards (scenes/gallery/NAME.png): each a moment of a scene, its middle cut out.
# usage: scenes/generate_pictures.sh PROGRAM
set -euo pipefail
program=$(realpath "$1")
cd "$(dirname "${BASH_SOURCE[0]}")"
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT

# picture SCENE SECONDS WIDTHxHEIGHT DOWN WORDS...: 219 x 144 pixels out of so many, so far below the upper edge
picture() {
  local name
  name=$(basename "$1")
  "$program" render "$1.gltf" --at "$2" --size "$3" --out "$folder/$name.png" --no-overlay --quiet "${@:5}"
  ffmpeg -v error -y -i "$folder/$name.png" -vf "crop=219:144:(in_w-219)/2:$4" -frames:v 1 "gallery/$name.png"
}
picture gallery/1_twist_and_slip 2.4 280x190 16
picture gallery/2_hysteresis 1.9 280x190 16
picture gallery/3_spin_and_slide 4 260x176 8
picture gallery/4_paper_and_truth 4.8 300x200 30
picture ball_on_cube 1.5 360x240 10 --heat none
picture compass_on_ellipsoid_soft 2 340x226 50
picture mallet_on_ellipsoid_soft 2 340x226 50
picture many_regions 2 300x200 20
picture two_bodies 2 340x226 28
picture looks/finger_on_lid 2 270x180 18 --heat none
picture looks/screwdriver_on_gel 2.8 280x184 40 --heat none
picture looks/stethoscope_on_belly 2.4 250x165 12 --heat none
picture looks/knob_on_mat 2 250x165 12 --heat none
picture looks/drill_on_foam 2.4 280x184 36 --heat none
