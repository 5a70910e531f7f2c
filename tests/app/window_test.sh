#!/usr/bin/env bash
# A person at the window, played by xdotool inside an Xvfb display of its own.
# usage: xvfb-run -a window_test.sh TORSION SCENE HAS_RED_BANNER FOLDER: leaves in FOLDER the session's JSON, what the
# validation layers said, screenshots that the P key took, a video and how long it had to be.
# HAS_RED_BANNER: a program that says so of a picture.
set -euo pipefail
torsion=$1 scene=$2 has_red_banner=$3 folder=$4
source "$(dirname "${BASH_SOURCE[0]}")/window_person.sh"
cd "$folder"
name=$(basename "$scene" .gltf)
cp "$scene" "$(dirname "$scene")"/*.bin .
export VK_INSTANCE_LAYERS=VK_LAYER_KHRONOS_validation
export VK_LAYER_ENABLES=VK_VALIDATION_FEATURE_ENABLE_SYNCHRONIZATION_VALIDATION_EXT

open_window "$name.gltf" --seconds 3000 --record session.rec
now() { date +%s.%N; }
# Of the last picture, after another is taken.
banner() {
  act
  "$has_red_banner" "${name}_$taken.png"
}
no_banner() { ! banner; }
# Big-endian, bytes 16 to 19 of a PNG.
is_wide() {
  act
  [ "$(od -An -tu4 -j16 -N4 --endian=big "${name}_$taken.png")" -eq "$1" ]
}

act
keep before
# Takes the ball, presses it down, turns it by the wheel.
act mousemove 800 200
act mousedown 1
for y in $(seq 220 20 260); do
  act mousemove 800 "$y"
done
xdotool click 4 click 4 click 4 click 4
sleep 0.5  # the plots' curves have a length
act
keep pressed
act mouseup 1
# A video of two seconds, between pictures that are in it.
taken=$((taken + 1))  # the video takes that number
film=$taken
earliest=$(now)
act key v
begun=$(now)
sleep 2
ending=$(now)
act
act key v
echo "[$begun, $ending, $earliest, $(now)]" >video_times.json
ln "${name}_$film.mp4" video.mp4
# Turns the view beside the body, and comes nearer.
act mousemove 480 600
act mousedown 1
act mousemove 520 590
act mousemove 600 560
act mouseup 1
act mousemove 480 600 click 4 click 4
keep turned
# Is taken away and comes back, changes its size.
xdotool windowunmap "$id"
sleep 0.3
xdotool windowmap --sync "$id" windowsize "$id" 900 600 windowfocus "$id"
until_true is_wide 900
keep resized
# The file changes on disk: to something bad, and back.
cp "$name.gltf" good.gltf
head -c 500 good.gltf >"$name.gltf"
until_true banner
keep bad
cp good.gltf "$name.gltf"
until_true no_banner
sleep 0.5  # of a recording
act
keep good
close_window
