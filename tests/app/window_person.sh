# What the scripts share that play a person at the window, inside an Xvfb display of its own. To be sourced, in the
# folder where all is to be left, with the program in $torsion and the scene's name in $name.

# open_window WORDS...: the program with these words. Sets id: of the window, focused
open_window() {
  "$torsion" view "$@" --json >session.json 2>session.err &
  session=$!
  trap 'kill $session 2>/dev/null || true' EXIT
  id=$(timeout 300 xdotool search --sync --onlyvisible --name Torsion | head -n 1)
  xdotool windowfocus "$id"
}

# until_true COMMAND...: waits until it is, for as long as a busy machine may take
until_true() {
  for _ in $(seq 3000); do
    ! "$@" || return 0
    sleep 0.1
  done
  echo "never: $*" >&2
  return 1
}

# act WORDS...: does that by xdotool and waits for a picture after it: a slow machine, too, sees every step by itself
taken=0
act() {
  [ $# = 0 ] || xdotool "$@"
  xdotool key p
  taken=$((taken + 1))
  until_true test -s "${name}_$taken.png"
}

# click X Y: so slowly that a slow machine sees the mouse come, the button go down, and go up
click() {
  xdotool mousemove "$1" "$2"
  act
  xdotool mousedown 1
  sleep 0.5
  act
  xdotool mouseup 1
  act
}

# keep NAME: the last picture, once more
keep() { ln "${name}_$taken.png" "$1.png"; }

close_window() {
  xdotool key Escape
  wait "$session"
}
