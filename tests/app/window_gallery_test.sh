#!/usr/bin/env bash
# The gallery: what opens without a word, the keys of its scenes, and scenes that begin again; inside an Xvfb display.
# usage: xvfb-run -a window_gallery_test.sh TORSION LOOPING ONCE FOLDER: leaves in FOLDER the sessions' JSON and
# screenshots that the P key took. LOOPING, ONCE: short scenes, of which the second says that it does not begin again.
set -euo pipefail
torsion=$1 looping=$2 once=$3 folder=$4
source "$(dirname "${BASH_SOURCE[0]}")/window_person.sh"
cd "$folder"
title_is() { [ "$(xdotool getwindowname "$id")" = "Torsion: $1.gltf" ]; }

# Without a word.
"$torsion" >/dev/null 2>bare.err &
bare=$!
id=$(timeout 300 xdotool search --sync --onlyvisible --name 'Torsion: 1_twist_and_slip.gltf' | head -n 1)
xdotool windowfocus "$id" key Escape
wait "$bare"

# Short scenes, then the gallery with the validation layers.
"$torsion" view "$looping" --seconds 7 --json >looping.json
"$torsion" view "$once" --seconds 5 --json >once.json
export VK_INSTANCE_LAYERS=VK_LAYER_KHRONOS_validation
export VK_LAYER_ENABLES=VK_VALIDATION_FEATURE_ENABLE_SYNCHRONIZATION_VALIDATION_EXT
open_window --seconds 3000
until_true title_is 1_twist_and_slip
name=1_twist_and_slip
act
keep first
act key 3
until_true title_is 3_spin_and_slide
name=3_spin_and_slide
act
keep third
# A card is clicked.
xdotool mousemove 270 75
act
xdotool mousedown 1
sleep 1
xdotool mouseup 1
until_true title_is 4_paper_and_truth
name=4_paper_and_truth
act
keep fourth
# A key of no scene changes nothing.
act key 0
title_is 4_paper_and_truth
act key 9
until_true title_is two_bodies
name=two_bodies
act
close_window
