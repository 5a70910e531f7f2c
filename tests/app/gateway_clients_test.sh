#!/usr/bin/env bash
# The clients of examples/gateway against the program: each holds the tool, feels the body push up, and the recording of it
# replays to the same bits. What C clients call of their makers is emulated.
# Their devices' services, and rclpy, are stood in for, too.
# usage: gateway_clients_test.sh TORSION SOURCE_FOLDER
set -euo pipefail
torsion=$1 source=$2
folder=$(mktemp -d)
trap 'jobs -p | xargs -r kill 2> /dev/null || true; rm -rf "$folder"' EXIT
scene=$source/scenes/ball_on_cube_soft.gltf

fail() {
  echo "FAILED: $*" >&2
  exit 1
}
json() { /usr/bin/python3 -c 'import json, sys; print(json.load(open(sys.argv[1]))'"$2"')' "$1"; }
is_between() { /usr/bin/python3 -c 'import sys; low, x, high = map(float, sys.argv[1:]); sys.exit(not low <= x <= high)' "$@"; }

# The hands of these clients go where they want, whatever the force: a check of signs would see nothing and take its time.
checks=(--no-sign-check)
# session NAME ADDRESS COMMAND...: runs the program with a client, which says what it felt to NAME.txt; a subshell, so that
# several may run at once, each at an address of its own
session() (
  name=$1 address=$2
  "$torsion" simulate "$scene" --realtime --seconds 1000 --device "gateway:$address" "${checks[@]}" "${network[@]}" \
    --record "$folder/$name.rec" --json > "$folder/$name.json" 2> "$folder/$name.err" &
  program=$!
  trap 'kill "$program" 2> /dev/null || true' EXIT
  sleep 1
  "${@:3}" < /dev/null > "$folder/$name.txt" || fail "$name: $(cat "$folder/$name.txt" "$folder/$name.err")"
  kill -INT "$program"
  wait "$program" || fail "$name: $(cat "$folder/$name.err")"
  cat "$folder/$name.txt"
  [[ $(json "$folder/$name.json" '["contact_steps"]') -gt 500 ]] || fail "$name: the tool touched nothing"
  "$torsion" simulate "$scene" --replay "$folder/$name.rec" --json > "$folder/$name.replay.json"
  [[ $(json "$folder/$name.json" '["world_hash"]') == $(json "$folder/$name.replay.json" '["world_hash"]') ]] ||
    fail "$name: the replay is another run"
)
# at_once COMMAND...: begins it; all_ended: waits for all that were begun, of which none may fail
begun=()
at_once() {
  "$@" &
  begun+=($!)
}
all_ended() {
  local each
  for each in "${begun[@]}"; do
    wait "$each" || exit 1
  done
  begun=()
}

# As another machine does it: through an address that others reach, with a secret.
(umask 077; head -c 32 /dev/urandom | base64 > "$folder/secret")
printf 'other secrets are of no use here\n' > "$folder/wrong"
own=$(hostname -I | cut -d ' ' -f 1)
own=${own:-127.0.0.1}
over_network() { local network=(--gateway-address 0.0.0.0 --gateway-secret "$folder/secret"); session "$@"; }
network=()

checks=()  # but it comes to an end there, too
at_once session python "$folder/socket" python3 "$source/examples/gateway/torsion_gateway.py" "$folder/socket" --seconds 3.5
checks=(--no-sign-check)

# Who has another secret, or none, is told nothing, and the user is told of him.
strangers() {
  local words
  sleep 1
  for words in "--secret $folder/wrong" ""; do
    # shellcheck disable=SC2086  # two words, or none
    timeout 1 python3 "$source/examples/gateway/torsion_gateway.py" "$own:7747" $words && return 1
  done
  true
}
"$torsion" simulate "$scene" --realtime --seconds 4 --device gateway --gateway-address 0.0.0.0 --gateway-secret "$folder/secret" --json \
  > "$folder/strangers.json" 2> "$folder/strangers.err" &
watched=$!
strangers || fail "a stranger's session came to an end"
wait "$watched" || fail "strangers: $(cat "$folder/strangers.err")"
[[ $(json "$folder/strangers.json" '["device"]["state"]') == *"another secret"* ]] || fail "strangers: not said"
[[ $(json "$folder/strangers.json" '["device"]["garbage"]') -gt 10 ]] || fail "strangers: not counted"

cxx=(c++ -std=c++17 -O1 -Wall -Wextra -Werror -I"$source/examples/gateway" -I"$source/tests/gateway_stubs")
"${cxx[@]}" -DTORSION_GATEWAY_NETWORK -o "$folder/chai3d" "$source/examples/gateway/chai3d.cpp" -lsodium
"${cxx[@]}" -o "$folder/rotations" "$source/tests/gateway_stubs/chai3d_rotations_test.cpp"
"$folder/rotations" || fail "chai3d: turns are wrong"
at_once over_network chai3d 7749 "$folder/chai3d" "$own" 7749 "$folder/secret"
for client in touch:hd:7750 force_dimension:dhd:7751; do
  IFS=: read -r name maker port <<< "$client"
  cc -std=c11 -Wall -Wextra -Werror -D_DEFAULT_SOURCE -I"$source/tests/gateway_stubs" -o "$folder/$name" \
    "$source/examples/gateway/$name.c" "$source/tests/gateway_stubs/${maker}_emulator.c" -lm
  cc -std=c11 -Wall -Wextra -Werror -D_DEFAULT_SOURCE -DCLIENT="\"$name.c\"" -I"$source/examples/gateway" \
    -I"$source/tests/gateway_stubs" -o "$folder/rotations" "$source/tests/gateway_stubs/rotations_test.c" \
    "$source/tests/gateway_stubs/${maker}_emulator.c" -lm
  "$folder/rotations" || fail "$name: turns are wrong"
  at_once session "$name" "$port" "$folder/$name" "$port"
done
all_ended
[[ $(json "$folder/python.json" '["device"]["signs"]') == "not seen" ]] || fail "python: what was seen of its signs"
read -r _ _ _ force _ _ _ _ torque _ < "$folder/python.txt"
# A ball of 30 mm pressed 1 mm into E = 1e4 Pa: some hundredths of a newton.
is_between 0.02 "$force" 0.5 || fail "force $force"
is_between 1e-5 "$torque" 0.1 || fail "torque $torque"

mcs -warnaserror -out:"$folder/client.exe" "$source/examples/gateway/TorsionGateway.cs"
at_once over_network c_sharp 7749 mono "$folder/client.exe" 7749 "$own" "$folder/secret"
# Up is z for ROS and for Haply.
at_once session ros 7747 env PYTHONPATH="$source/tests/gateway_stubs/ros" /usr/bin/python3 "$source/examples/gateway/ros2_node.py"
/usr/bin/python3 "$source/tests/gateway_stubs/haply_service.py" 10011 > "$folder/service.txt" 2>&1 &
service=$!
until grep -q ready "$folder/service.txt"; do sleep 0.1; done
at_once over_network haply 7750 /usr/bin/python3 "$source/examples/gateway/haply.py" --gateway "$own:7750" --secret "$folder/secret" --service ws://127.0.0.1:10011 --seconds 3.5
all_ended
wait "$service" || fail "haply: $(cat "$folder/service.txt")"
grep -q sideways "$folder/service.txt" && fail "haply: $(cat "$folder/service.txt")"
cp "$folder/service.txt" "$folder/haply.txt"
# Up is y for Torsion and HDAPI, and z for the others: a wrong axis or sign is seen here. The largest force upwards is
# looked at, and not the last one: after a stall of a busy machine the force rises anew for a second.
for check in touch:2 force_dimension:3 c_sharp:2 ros:3 haply:3 chai3d:3; do
  IFS=: read -r name axis <<< "$check"
  line=$(grep '^force' "$folder/$name.txt")
  read -ra words <<< "${line//,/}"
  is_between 0.02 "${words[6]}" 0.5 || fail "$name: $line"  # up to
  for other in 1 2 3; do
    [[ $other == "$axis" ]] || is_between -0.01 "${words[other]}" 0.01 || fail "$name: $line"
  done
done
# The way there and back is a part of the delay that Torsion has to count on. One after the other: these times are small.
for client in "python3 $source/examples/gateway/torsion_gateway.py" "$folder/touch" "mono $folder/client.exe"; do
  /usr/bin/python3 "$source/tests/gateway_stubs/slow_gateway.py" 7748 > "$folder/slow.txt" 2>&1 &
  slow=$!
  until grep -q ready "$folder/slow.txt"; do sleep 0.1; done
  timeout 20 $client 7748 < /dev/null > /dev/null 2>&1 &
  connected=$!
  wait "$slow" || fail "$client against a slow gateway: $(cat "$folder/slow.txt")"
  kill "$connected" 2> /dev/null || true
  is_between 0.002 "$(sed -n 's/^delay //p' "$folder/slow.txt")" 1 || fail "$client: $(cat "$folder/slow.txt")"
done
echo "gateway clients: all passed"
