#!/usr/bin/env bash
# A person at the window, played by xdotool inside an Xvfb display of its own.
# usage: xvfb-run -a window_test.sh TORSION SCENE FOLDER: leaves in FOLDER the session's JSON, what the
# validation layers said, and screenshots that the P key took.
set -euo pipefail
torsion=$1 scene=$2 folder=$3
cd "$folder"
name=$(basename "$scene" .gltf)
cp "$scene" "$(dirname "$scene")"/*.bin .
export VK_INSTANCE_LAYERS=VK_LAYER_KHRONOS_validation
export VK_LAYER_ENABLES=VK_VALIDATION_FEATURE_ENABLE_SYNCHRONIZATION_VALIDATION_EXT

"$torsion" view "$name.gltf" --seconds 60 --json --record session.rec >session.json 2>session.err &
session=$!
trap 'kill $session 2>/dev/null || true' EXIT
id=$(timeout 30 xdotool search --sync --onlyvisible --name Torsion | head -n 1)
xdotool windowfocus "$id"

# wait_for FILE: until the window has written it
wait_for() {
  for _ in $(seq 200); do
    [ ! -s "$1" ] || return 0
    sleep 0.1
  done
  echo "no $1" >&2
  return 1
}
shot() {
  xdotool key p
  wait_for "${name}_$1.png"
}

shot 1
# Takes the ball, presses it down, turns it by the wheel.
xdotool mousemove 640 200 mousedown 1
for y in $(seq 205 5 260); do
  xdotool mousemove 640 "$y"
  sleep 0.03
done
xdotool click 4 click 4 click 4 click 4
sleep 0.7
shot 2
xdotool mouseup 1
# A video of two seconds.
xdotool key v
sleep 2
xdotool key v
wait_for "${name}_3.mp4"
# Turns the view beside the body, and comes nearer.
xdotool mousemove 480 600 mousedown 1 mousemove 520 590 mousemove 600 560 mouseup 1
xdotool mousemove 480 600 click 4 click 4
sleep 0.3
shot 4
# Switches the model on the run, is taken away and comes back, changes its size.
xdotool windowunmap "$id"
sleep 0.3
xdotool windowmap "$id"
xdotool windowsize "$id" 900 600
sleep 1
xdotool windowfocus "$id"
shot 5
# The file changes on disk: to something bad, and back.
cp "$name.gltf" good.gltf
head -c 500 good.gltf >"$name.gltf"
sleep 1.6
shot 6
cp good.gltf "$name.gltf"
sleep 3
shot 7
xdotool key Escape
wait $session
