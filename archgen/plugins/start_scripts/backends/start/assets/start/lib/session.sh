# shellcheck shell=bash disable=SC2154,SC2034 # engine.sh has the other variables
# One run of a computer's script: its folder for logs, what ends it, and what it says at its end.

stop_all() {
  local i
  for ((i = ${#ids[@]} - 1; i >= 0; i--)); do stop_step "${ids[i]}"; done
}

say_end() {
  local id line
  [[ -z $failure ]] || while IFS= read -r line; do
    printf '            %s\n' "| $line" >&2 2>/dev/null
  done < <(tail -n 5 -- "$run/${log[$failure]}" 2>/dev/null)
  for id in "${ids[@]}"; do
    case ${state[$id]} in
      planned) [[ ${kind[$id]} == elsewhere ]] || say 'not up' "$id" "$(describe_open_waits "$id")" ;;
      starting) [[ ${kind[$id]} == elsewhere ]] || say 'not up' "$id" "$(describe_missing "$id")" ;;
      failed) say 'not up' "$id" "${reason[$id]}" ;;
    esac
  done
}

describe_missing() { # ID
  local missing
  missing=$(cat -- "$run/$1.missing" 2>/dev/null)
  if [[ ${kind[$1]} == once ]]; then
    printf 'it has not come to its end'
  else
    printf '%s' "${missing:-nobody has looked at it yet}"
  fi
}

describe_open_waits() { # ID
  local -n its_awaited=awaited_${number[$1]}
  local i open=()
  for ((i = 0; i < ${#its_awaited[@]}; i += 2)); do
    is_done "${its_awaited[i]}" || open+=("${its_awaited[i]}")
  done
  if ((${#open[@]})); then
    printf 'not started, it waits for %s' "${open[*]}"
  else
    printf 'not started, it was not its turn'
  fi
}

# What is missing is said before anything starts.
find_missing_programs() {
  local id
  for id in "${ids[@]}"; do
    local -n its_words=words_${number[$id]} its_variables=variables_${number[$id]}
    [[ ${kind[$id]} != elsewhere && ${#its_words[@]} -gt 0 && ${its_words[0]} != */* ]] || continue
    [[ " ${its_variables[*]-}" == *' PATH='* || -n ${user[$id]-} ]] || type -P -- "${its_words[0]}" >/dev/null ||
      printf '%s needs the program %s, which is not on the path\n' "$id" "${its_words[0]}"
  done
  for id in "${ids[@]}"; do
    [[ ${kind[$id]} != elsewhere && -n ${user[$id]-} && ${user[$id]} != "$(id -un)" ]] || continue
    local user_words
    find_user_words "$id"
    "${user_words[@]}" true 2>/dev/null || printf '%s runs as %s, and this user may not become that one\n' "$id" "${user[$id]}"
  done
  for id in "${ids[@]}"; do
    [[ ${kind[$id]} != elsewhere && -n ${cpu_words[$id]-} && ${START_SCHEDULING-} != no ]] || continue
    local words user_words
    read -ra words <<<"${cpu_words[$id]}"
    find_user_words "$id"
    "${user_words[@]}" "${words[@]}" true 2>/dev/null ||
      printf '%s cannot be started with %s: that needs rights (rtprio in limits.conf) and these cores; START_SCHEDULING=no starts all without\n' "$id" "${cpu_words[$id]}"
  done
}

make_run_folder() { # NAME
  local folder=${START_LOGS:-$top/logs} name n
  printf -v name '%(%Y-%m-%dT%H-%M-%S)T' -1
  name=${1:-$name} n=2
  mkdir -p -- "$folder" || exit 2
  exec {locked}>>"$folder/.$host.lock"
  flock -n "$locked" || { printf 'What runs on %s is running already; its logs are in %s\n' "$host" "$folder" >&2; exit 2; }
  run=$folder/$name
  until mkdir -- "$run" 2>/dev/null; do
    [[ -e $run && -z $1 ]] || [[ -d $run && -n $1 ]] || { printf '%s cannot be made\n' "$run" >&2; exit 2; }
    [[ -z $1 ]] || return
    run=$folder/$name-$n n=$((n + 1))
  done
}

# If this script itself is killed, somebody is left who ends what it started.
guard_run() {
  local id marks=()
  for id in "${ids[@]}"; do marks+=(-e "$(mark "$id")"); done
  mkfifo -- "$run/.guard$host" "$run/.never$host"
  exec {never}<>"$run/.never$host"
  set -m
  (
    exec {never}>&- {locked}>&-
    trap '' INT TERM HUP
    read -r line <"$run/.guard$host"
    [[ $line == 'done' ]] && exit
    for signal in INT TERM KILL; do
      mapfile -t pids < <(grep -lszFx "${marks[@]}" /proc/[0-9]*/environ | tr -cd '0-9\n')
      ((${#pids[@]})) || exit
      kill -s "$signal" -- "${pids[@]}"
      for ((tenths = 0; tenths < 10 * patience; tenths++)); do
        sleep 0.1
        grep -qszFx "${marks[@]}" /proc/[0-9]*/environ || exit
      done
    done
  ) </dev/null >/dev/null 2>&1 &
  set +m
  exec {guarded}>"$run/.guard$host"
  rm -f -- "$run/.guard$host" "$run/.never$host"
}

interrupt_by() { # SIGNAL
  # Who asks twice does not want to wait.
  [[ -z $interrupt ]] || patience=0
  interrupt=${interrupt:-$1}
}

end_run() {
  local status=$?
  trap - EXIT
  [[ -n $guarded ]] || exit "$status"
  case $interrupt in
    INT | TERM | HUP) say ending all "by SIG$interrupt" ;;
    lost) say ending all 'the script above is gone' ;;
    *) [[ -z $failure ]] || say ending all "because of $failure" ;;
  esac
  [[ -n $failure || $interrupt == asked ]] || is_follower=no
  # The script above stops the steps of all computers, the last one first; when it is gone, that is done here.
  while [[ $is_follower == yes ]]; do pause 0.2; done
  stop_all
  say_end
  printf 'done\n' >&"$guarded"
  rm -f -- "$run"/*.missing
  if [[ -n $failure || $interrupt == lost || $left_over == yes ]]; then
    status=1
  elif [[ $announced == yes || $interrupt == asked ]]; then
    status=0
  elif [[ -n $interrupt ]]; then
    status=$((128 + $(kill -l "$interrupt")))
  fi
  say stopped all "status $status, logs in $run"
  exit "$status"
}

start_all() { # OPTION...
  local missing name=''
  while (($#)); do
    case $1 in
      --follow) is_follower=yes shown_host=$host name=$2; shift 2 ;;
      --help) printf 'Usage: %s\nStarts what runs on %s, and stops it again when it is interrupted.\n' "$0" "$host"; exit ;;
      *) printf 'What is %q? There is only --help.\n' "$1" >&2; exit 2 ;;
    esac
  done
  [[ -e /proc/self/stat ]] || { printf 'This needs Linux: processes are found in /proc.\n' >&2; exit 2; }
  missing=$(find_missing_programs)
  if [[ -n $missing ]]; then
    printf '%s\n' "$missing" 'Nothing was started.' >&2
    tell failed .
    exit 2
  fi
  trap end_run EXIT
  trap 'interrupt_by INT' INT
  trap 'interrupt_by TERM' TERM
  trap 'interrupt_by HUP' HUP
  trap : PIPE
  make_run_folder "$name"
  guard_run
  say logs "$run"
  tell ready .
  bring_up
}
