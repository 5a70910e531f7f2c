#!/usr/bin/env bash
# What goes wrong with windows, inside an Xvfb display: surfaces that are lost (tests/support/lose_surface_layer.cpp), a
# window that moves, changes its size, or is minimised while the mouse drags the tool.
# usage: xvfb-run -a window_trouble_test.sh TORSION SCENE LAYERS FOLDER: leaves in FOLDER the session's JSON, what it
# said, and screenshots that the P key took. LAYERS: where the layer's manifest lies.
set -euo pipefail
torsion=$1 scene=$2 layers=$3 folder=$4
source "$(dirname "${BASH_SOURCE[0]}")/window_person.sh"
cd "$folder"
name=$(basename "$scene" .gltf)
export VK_LAYER_PATH=/usr/share/vulkan/explicit_layer.d:$layers
export VK_INSTANCE_LAYERS=VK_LAYER_KHRONOS_validation:VK_LAYER_TORSION_lose_surface
export VK_LAYER_ENABLES=VK_VALIDATION_FEATURE_ENABLE_SYNCHRONIZATION_VALIDATION_EXT
export TORSION_LOSE_SURFACE="acquire:5 capabilities:1 present:5 swapchain:1"

open_window "$scene" --seconds 3000

# What a window manager does; there is none here.
minimise() {
  xprop -id "$id" -f WM_STATE 32c -set WM_STATE 3
  xdotool windowunmap "$id"
  sleep 1
}
restore() {
  xdotool windowmap "$id"
  xprop -id "$id" -f WM_STATE 32c -set WM_STATE 1
  sleep 0.5
  act windowfocus "$id"
}

all_lost() { [ "$(grep -c 'surface given up' session.err)" = 4 ]; }
until_true all_lost
# The animation ends, with the ball above the body, and does not begin again.
act key l
sleep 6
# Takes the ball up, then to the right.
act key f
act mousemove 800 200
act mousedown 1
act mousemove 800 140
act mouseup 1
keep lifted
act mousedown 1
act mousemove 860 140
act mouseup 1
keep right
# Takes it back, while the window goes away under the mouse.
act mousedown 1
act windowmove "$id" 40 30
act windowsize "$id" 1000 600
act windowsize "$id" 1280 720
act mousemove 800 140
act mouseup 1
act windowmove "$id" 0 0
keep back
# Takes it, and the window is minimised; the button is let go elsewhere.
act mousedown 1
minimise
xdotool mousemove 300 400
xdotool mouseup 1
restore
act mousemove 800 140
act mousemove 860 140
keep let_go
# Can be taken again.
act mousemove 800 140
act mousedown 1
act mousemove 860 140
act mouseup 1
keep again
close_window
