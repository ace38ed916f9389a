#!/usr/bin/env bash
# Waits until something is up: until each of the signs was seen, one after the other.
#
#   wait_until_up.sh [--look] [--missing FILE] [--address HOST] [--output FILE BYTES] SIGN... [-- WORD...]
#
#   --port N, --file PATH, --topic NAME, --service NAME, --log WORDS (of its output), --time SECONDS
#   --lifecycle NODE STATE TRANSITIONS   these transitions bring the node into the state
#   --load CONTAINER                     the words behind -- load a node into that container
#
# --look looks once and waits for nothing, --missing keeps in FILE what is still missing, --address is where the port is,
# --output is the file with the output, the first BYTES of which are older.
# The status is 0 if all was seen, 1 if not, and 2 if it never will be.
set -u

only_look=no patience=30 missing_file='' missed='' address=localhost output='' older_bytes=0
signs=() changes=() loads=()
while (($#)); do
  case $1 in
    --look) only_look=yes patience=10; shift ;;
    --missing) missing_file=$2; shift 2 ;;
    --address) address=$2; shift 2 ;;
    --output) output=$2 older_bytes=$3; shift 3 ;;
    --port | --file | --log | --time) signs+=("${1#--}" "$2"); shift 2 ;;
    --topic | --service) signs+=("${1#--}" "${START_PREFIX-}$2"); shift 2 ;;
    --load) loads=(service "${START_PREFIX-}$2/_container/load_node" load "${START_PREFIX-}$2"); shift 2 ;;
    --lifecycle)
      node=${START_PREFIX-}$2
      changes=(service "$node/change_state")
      for transition in $4; do changes+=(transition "$node $transition"); done
      changes+=(state "$node $3")
      shift 4
      ;;
    --) shift; break ;;
    *) printf 'wait_until_up.sh: what is %q?\n' "$1" >&2; exit 2 ;;
  esac
done
load_words=("$@")

# Written only when it is another text: whoever reads the file while it is written finds nothing.
miss() {
  [[ -z $missing_file || $1 == "$missed" ]] || printf '%s\n' "$1" >"$missing_file"
  missed=$1
}

has_line() { [[ $'\n'$1$'\n' == *$'\n'"$2"$'\n'* ]]; }

accepts_connections() { timeout 3 bash -c "exec 3<>\"/dev/tcp/\$1/\$2\"" look "$address" "$1" 2>/dev/null; }

has_message() {
  if [[ ${ROS_VERSION:-2} == 1 ]]; then
    timeout "$patience" rostopic echo -n 1 "$1" >/dev/null 2>&1
  else
    timeout "$patience" ros2 topic echo --once "$1" >/dev/null 2>&1
  fi
}

is_offered() {
  if [[ ${ROS_VERSION:-2} == 1 ]]; then
    has_line "$(timeout 10 rosservice list 2>/dev/null)" "$1" || has_line "$(timeout 10 rostopic list 2>/dev/null)" "$1/goal"
  else
    has_line "$(timeout 10 ros2 service list 2>/dev/null)" "$1" || has_line "$(timeout 10 ros2 action list 2>/dev/null)" "$1"
  fi
}

has_words() {
  local text
  { text=$(tail -c "+$((older_bytes + 1))" -- "$output"); } 2>/dev/null
  [[ $text == *"$1"* ]]
}

# In a container of compose: how long its first process has run.
has_run_for() {
  local fields
  fields=$(</proc/1/stat)
  read -r -a fields <<<"${fields##*) }"
  awk -v asked="$1" -v started="${fields[19]}" -v ticks="$(getconf CLK_TCK)" \
    '{ exit !($1 - started / ticks >= asked) }' /proc/uptime
}

has_state() {
  local state
  state=$(timeout 10 ros2 lifecycle get "$1" 2>/dev/null)
  [[ ${state%% *} == "$2" ]]
}

look() { # KIND TARGET
  case $1 in
    port) miss "the port $2 does not accept connections"; accepts_connections "$2" ;;
    file) miss "there is no file $2"; test -e "$2" ;;
    topic) miss "no message has come on $2"; has_message "$2" ;;
    service) miss "$2 is not offered"; is_offered "$2" ;;
    log) miss "its output does not hold \"$2\""; has_words "$2" ;;
    state) miss "${2% *} is not ${2##* }"; has_state "${2% *}" "${2##* }" ;;
    time) miss "$2 s have not passed"; has_run_for "$2" ;;
  esac
}

run_or_end() { # WHAT WORD...
  local what=$1 status=0
  shift
  miss "$what"
  "$@" || status=$?
  ((status == 0)) && return
  miss "$what failed with status $status"
  exit 2
}

see() { # KIND TARGET
  [[ $only_look == no ]] || { look "$1" "$2"; return; }
  case $1 in
    time) miss "$2 s have not passed"; sleep "$2" ;;
    load) run_or_end "loading it into $2" "${load_words[@]}" ;;
    transition) run_or_end "${2##* } of ${2% *}" ros2 lifecycle set "${2% *}" "${2##* }" ;;
    state) look "$1" "$2" || exit 2 ;;
    *) until look "$1" "$2"; do sleep 0.2; done ;;
  esac
}

set -- ${loads[@]+"${loads[@]}"} ${changes[@]+"${changes[@]}"} ${signs[@]+"${signs[@]}"}
while (($#)); do
  see "$1" "$2" || exit 1
  shift 2
done
