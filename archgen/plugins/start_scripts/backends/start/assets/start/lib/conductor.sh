# shellcheck shell=bash
# Starts the scripts of several computers, tells each of them how far the others are, and stops the steps of all of them,
# the last one first. start.sh reads this file.

hosts=() step_ids=() failure='' interrupt='' announced=no run_name=''
declare -A title=() address=() reach=() folder_at=() wire=() host_of=() stopped=() running=() complete=() idle=()
library=$(cd -- "$(dirname -- "${BASH_SOURCE[0]}")" && pwd)
top=${library%/*/*}
if [[ -f $top/settings.sh ]]; then
  # shellcheck source=/dev/null
  source "$top/settings.sh"
fi
set -u

computer() { hosts+=("$1") title[$1]=$2 address[$1]=${address[$1]-$3}; } # ID TITLE ADDRESS
order() { step_ids+=("$2") host_of[$2]=$1; } # HOST STEP

say() { printf '%(%H:%M:%S)T  %-9s %s\n' -1 "$1" "$2" >&2 2>/dev/null; }

explain() {
  local host
  printf 'This starts %d steps on %d computers, and has to be told how to reach them. One of:\n\n' "${#step_ids[@]}" "${#hosts[@]}"
  printf '  %s --all-here       all of it on this computer\n' "$0"
  printf '  %s --here HOST      HOST is this computer (again for each that is), the others are reached by ssh\n' "$0"
  printf '  %s --ssh            all are reached by ssh\n\n' "$0"
  printf 'By ssh, each needs this folder under the same path; settings.sh may say otherwise. Or by hand, on each computer:\n\n'
  for host in "${hosts[@]}"; do printf '  bash start/hosts/%s.sh    # %s\n' "$host" "${title[$host]}"; done
}

run_script() { # HOST
  local words=("start/hosts/$1.sh" --follow "$run_name")
  if [[ ${reach[$1]} == here ]]; then
    cd -- "$top" && exec bash "${words[@]}"
  fi
  exec ssh -T -o BatchMode=yes -- "${reach[$1]}" "cd $(printf %q "${folder_at[$1]:-$top}") && exec bash $(printf '%q ' "${words[@]}")"
}

open_wires() {
  local host end
  pipes=$(mktemp -d) || exit 2
  mkfifo -- "$pipes/events"
  exec {events}<>"$pipes/events"
  for host in "${hosts[@]}"; do
    mkfifo -- "$pipes/$host"
    set -m
    (
      exec {events}>&-
      run_script "$host" <"$pipes/$host" | while IFS= read -r line; do printf '%s %s\n' "$host" "$line"; done
      printf '%s gone .\n' "$host"
    ) >"$pipes/events" &
    running[$host]=$!
    set +m
  done
  # Only now, so that none of the scripts holds another one's wire open: they notice when this script is gone.
  for host in "${hosts[@]}"; do
    exec {end}>"$pipes/$host"
    wire[$host]=$end
  done
}

send() { # HOST LINE
  local end=${wire[$1]}
  { printf '%s\n' "$2" >&"$end"; } 2>/dev/null
}

hear() { # SECONDS
  local host word id other status=0
  read -r -t "$1" -u "$events" host word id || return 0
  case $word in
    starting | up | ended | skipped)
      for other in "${hosts[@]}"; do [[ $other == "$host" ]] || send "$other" "$word $id"; done
      ;;
    failed) failure=${failure:-$id on $host} ;;
    stopped) stopped[$id]=yes ;;
    complete) complete[$host]=yes ;;
    idle) idle[$host]=yes ;;
    gone)
      unset "running[$host]"
      failure=${failure:-$host, whose script is gone}
      ;;
  esac
}

stop_all() {
  local i id host until end
  for ((i = ${#step_ids[@]} - 1; i >= 0; i--)); do
    id=${step_ids[i]} host=${host_of[${step_ids[i]}]}
    [[ -n ${running[$host]-} ]] || continue
    send "$host" "stop $id"
    until=$((SECONDS + 30 + 3 * ${START_PATIENCE:-5}))
    while [[ -z ${stopped[$id]-} && -n ${running[$host]-} ]] && ((SECONDS < until)); do hear 0.5; done
  done
  for host in "${hosts[@]}"; do
    end=${wire[$host]}
    exec {end}>&-
  done
  until=$((SECONDS + 30 + 3 * ${START_PATIENCE:-5}))
  while ((${#running[@]} && SECONDS < until)); do hear 0.5; done
  for host in "${!running[@]}"; do
    say left "$host: its script does not end"
    failure=${failure:-$host}
    kill -s TERM -- "-${running[$host]}"
  done
}

end_all() {
  local status=$? cause=$failure
  trap - EXIT
  [[ -z $interrupt ]] || say ending "all: by SIG$interrupt"
  [[ -z $failure ]] || say ending "all: because of $failure"
  trap : INT TERM HUP
  stop_all
  rm -rf -- "$pipes"
  if [[ -n $cause ]]; then
    status=1
  elif [[ -n $interrupt && $announced == no ]]; then
    status=$((128 + $(kill -l "$interrupt")))
  fi
  say stopped "all: status $status"
  exit "$status"
}

conduct() { # OPTION...
  local host others=''
  while (($#)); do
    case $1 in
      --all-here) for host in "${hosts[@]}"; do reach[$host]=here; done; shift ;;
      --here) reach[${2:-}]=here others=ssh; shift 2 ;;
      --ssh) others=ssh; shift ;;
      --help) explain; exit ;;
      *) printf 'What is %q?\n\n' "$1" >&2; explain >&2; exit 2 ;;
    esac
  done
  for host in "${!reach[@]}"; do
    [[ -n ${title[$host]-} ]] || { printf 'There is no computer %q: there are %s\n' "$host" "${hosts[*]}" >&2; exit 2; }
  done
  for host in "${hosts[@]}"; do
    [[ -n ${reach[$host]-} || -z $others ]] || reach[$host]=${address[$host]}
    [[ -n ${reach[$host]-} ]] || { explain >&2; exit 2; }
  done
  printf -v run_name '%(%Y-%m-%dT%H-%M-%S)T-%s' -1 "$$"
  open_wires
  trap end_all EXIT
  trap 'interrupt=INT' INT
  trap 'interrupt=TERM' TERM
  trap 'interrupt=HUP' HUP
  trap : PIPE
  while [[ -z $failure && -z $interrupt ]]; do
    hear 0.5
    ((${#idle[@]} < ${#hosts[@]})) || exit 0
    if [[ $announced == no ]] && ((${#complete[@]} == ${#hosts[@]})); then
      announced=yes
      say up "all: ${#step_ids[@]} steps on ${#hosts[@]} computers"
    fi
  done
}
