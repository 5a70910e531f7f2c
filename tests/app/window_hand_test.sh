#!/usr/bin/env bash
# A hand at the window: presses along the normal, turns by the wheel and by the ring, and moves the tool by numbers; inside
# an Xvfb display.
# usage: xvfb-run -a window_hand_test.sh TORSION SCENE FOLDER: leaves in FOLDER the recording, its trace, and screenshots
# that the P key took.
set -euo pipefail
torsion=$1 scene=$2 folder=$3
source "$(dirname "${BASH_SOURCE[0]}")/window_person.sh"
cd "$folder"
name=$(basename "$scene" .gltf)

open_window "$scene" --seconds 3000 --record session.rec
sleep 4  # the animation is over, and the tool above the cube
act
# The panel's part about moving the tool, without the plots above it.
click 160 209
click 160 259
act mousemove 800 190
act mousedown 1
act mousemove 800 220
act mousemove 800 250
xdotool click 4 click 4 click 4
sleep 0.5
act
keep pressed
act mouseup 1
# The near side of the ring around the tool, to the right and at once.
sleep 2
act mousemove 800 279
act mousedown 1
act mousemove 860 275
keep ringed
act mouseup 1
# The field of the turn. While it has the keys nothing else hears of them, so there are no pictures to wait for.
xdotool mousemove 60 306
act
xdotool mousedown 1
sleep 1
xdotool mouseup 1
sleep 1
xdotool key BackSpace
sleep 1
xdotool type --delay 100 30
sleep 1
xdotool key Return
sleep 2  # keys are the field's until it is done
act
keep typed
# A digit was of the field, not of the gallery.
[ "$(xdotool getwindowname "$id")" = "Torsion: $name.gltf" ]
click 24 399
sleep 4
act
keep moved
# The camera goes away and comes back.
act mousemove 480 600
act mousedown 1
act mousemove 600 560
act mouseup 1
keep orbited
act key c
act
keep back
# Let go of, the tool goes back to where the animation has it.
act key g
sleep 3
act
keep let_go
# One scene is recorded: a key of the gallery must not throw that away.
act key 3
sleep 1
[ "$(xdotool getwindowname "$id")" = "Torsion: $name.gltf" ]
close_window
"$torsion" simulate --replay session.rec --trace trace.csv --columns usual,turn_rad "$scene" --quiet
