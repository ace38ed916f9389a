# shellcheck shell=bash
# Starts the steps that a computer's script names, in their order, watches them, and stops them again, the last one first.
# The script reads this file. It needs bash 4.4, and what any Linux has beside.

ids=() failure='' interrupt='' announced=no is_follower=no run=''
phases=(network simulators core components)
declare -A phase=() number=() kind=() host_of=() state=() log=() within=() user=() directory=() respawn=() cpu_words=()
declare -A deadline=() again_at=() reason=() told_at=() address=() is_told=() is_brought=()
guarded='' never='' locked='' left_over=no shown_host='' host='' open_phase=network
library=$(cd -- "$(dirname -- "${BASH_SOURCE[0]}")" && pwd)
top=${library%/*/*}
settings=$top/settings.sh
START_FOLDER=$top
if [[ -f $settings ]]; then
  # shellcheck source=/dev/null
  source "$settings"
fi
patience=${START_PATIENCE:-5}
set -u
# shellcheck source-path=SCRIPTDIR source=processes.sh
source "$library/processes.sh"
# shellcheck source-path=SCRIPTDIR source=session.sh
source "$library/session.sh"

this_computer() { host=$1; }

# A computer that is another one, and the address under which it is found, unless settings.sh says another one.
other_computer() { address[$1]=${address[$1]-$2}; } # ID ADDRESS

# step ID [OPTION...] [-- WORD...]: what starts, after what, and how one sees that it is up.
step() {
  local id=$1 n=${#ids[@]}
  shift
  ids+=("$id")
  number[$id]=$n kind[$id]=nobody state[$id]=planned phase[$id]=components log[$id]=$id.log
  declare -ga "words_$n=()" "signs_$n=()" "variables_$n=()" "awaited_$n=()" "before_$n=()"
  local -n its_words=words_$n its_signs=signs_$n its_variables=variables_$n its_awaited=awaited_$n its_before=before_$n
  while (($#)); do
    case $1 in
      --phase) phase[$id]=$2; shift 2 ;;
      --on) host_of[$id]=$2 kind[$id]=elsewhere; shift 2 ;;
      --by-others) is_told[$id]=no; shift ;;
      --after) its_awaited+=("$2" up); shift 2 ;;
      --after-start-of) its_awaited+=("$2" started); shift 2 ;;
      --port | --file | --topic | --service | --log | --time) its_signs+=("$1" "$2"); shift 2 ;;
      --lifecycle) its_signs+=("$1" "$2" "$3" "$4") is_brought[$id]=yes; shift 4 ;;
      --load) its_signs+=("$1" "$2") kind[$id]=loaded; shift 2 ;;
      --within) within[$id]=$2; shift 2 ;;
      --once) kind[$id]=once; shift ;;
      --respawn) respawn[$id]=$2; shift 2 ;;
      --set) its_variables+=("$2"); shift 2 ;;
      --in) directory[$id]=$2; shift 2 ;;
      --as) user[$id]=$2; shift 2 ;;
      --same) its_before+=("$1" "$2"); shift 2 ;;
      --fill) its_before+=("$1"); shift ;;
      --cpu) cpu_words[$id]=${*:3:$2} its_before+=("$1" "$2" "${@:3:$2}"); shift $(($2 + 2)) ;;
      --before) its_before+=("$1" "$2" "${@:3:$2}"); shift $(($2 + 2)) ;;
      --value) its_before+=("$1" "$2" "$3" "${@:4:$3}"); shift $(($3 + 3)) ;;
      --) shift; break ;;
      *) printf '%s: what is %q?\n' "$id" "$1" >&2; exit 2 ;;
    esac
  done
  its_words=("$@")
  [[ ${kind[$id]} != nobody || $# == 0 ]] || kind[$id]=program
}

say() { # WHAT ID [WORDS]
  local line
  printf -v line '%(%H:%M:%S)T  %-9s %s%s' -1 "$1" "$2" "${3:+: $3}"
  # Whoever read it may be gone: what was started is stopped all the same.
  printf '%s%s\n' "${shown_host:+[$shown_host] }" "$line" >&2 2>/dev/null
  [[ -z $run ]] || printf '%s\n' "$line" >>"$run/start${shown_host:+-$shown_host}.log"
}

tell() { # WHAT ID: to the script above, which tells the other computers
  [[ $is_follower == no ]] || printf '%s %s\n' "$1" "$2" 2>/dev/null
}

fail() { # ID WHY
  state[$1]=failed reason[$1]=$2
  failure=${failure:-$1}
  say failed "$1" "$2"
  tell failed "$1"
}

become() { # STATE ID
  state[$2]=$1
  say "$1" "$2"
  tell "$1" "$2"
}

# What the script above says of other computers: "up ID" and the like, or "stop ID".
obey() {
  local word=${1%% *} id=${1#* }
  if [[ $word == stop ]]; then
    [[ -n $interrupt ]] || interrupt=asked
    [[ -z ${number[$id]-} ]] || stop_step "$id"
    tell stopped "$id"
  elif [[ ${kind[$id]-} == elsewhere ]]; then
    state[$id]=$word
  fi
}

partial=''
pause() { # SECONDS; meanwhile, what the script above says is heard
  local line='' status=0
  if [[ $is_follower == no ]]; then
    read -r -t "$1" -u "$never" line || true
    return
  fi
  read -r -t "$1" line || status=$?
  partial+=$line
  if ((status == 0)); then
    line=$partial partial=''
    obey "$line"
  elif ((status <= 128)); then
    is_follower=no
    interrupt=${interrupt:-lost}
  fi
}

is_done() { [[ ${state[$1]} == up || ${state[$1]} == ended || ${state[$1]} == skipped ]]; }

is_free() { # ID: all that it waits for is there
  local -n waits=awaited_${number[$1]}
  local i awaited
  for ((i = 0; i < ${#waits[@]}; i += 2)); do
    awaited=${waits[i]}
    is_done "$awaited" && continue
    [[ ${waits[i + 1]} == started && ${state[$awaited]} == starting ]] || return 1
  done
}

# Steps of a later phase than this one wait.
find_open_phase() {
  local id
  for open_phase in "${phases[@]}"; do
    for id in "${ids[@]}"; do
      [[ ${phase[$id]} != "$open_phase" ]] || is_done "$id" || return 0
    done
  done
}

is_in_turn() { # ID
  local each
  for each in "${phases[@]}"; do
    [[ ${phase[$1]} == "$each" ]] && return 0
    [[ $each == "$open_phase" ]] && return 1
  done
}

begin() { # ID
  local id=$1
  told_at[$id]=$SECONDS
  local -n signs=signs_${number[$1]}
  case ${kind[$id]} in
    elsewhere)
      [[ $is_follower == yes && -z ${is_told[$id]-} ]] && return
      become starting "$id"
      watch_from_afar "$id"
      ;;
    nobody)
      if ((${#signs[@]} == 0)); then
        say skipped "$id" 'nothing says how it starts'
        state[$id]=skipped
        tell skipped "$id"
        return
      fi
      become starting "$id"
      watch "$id"
      ;;
    loaded)
      become starting "$id"
      watch "$id"
      ;;
    *)
      become starting "$id"
      launch "$id"
      watch "$id"
      ;;
  esac
  begin_patience "$id"
}

begin_patience() { # ID: from now on it has its time to come up
  [[ -z ${within[$1]-} ]] || deadline[$1]=$((SECONDS + $(round_up "${within[$1]}") + 1))
}

round_up() { # SECONDS
  local whole=${1%.*}
  [[ $whole == "$1" ]] || whole=$((whole + 1))
  printf '%s' "$whole"
}

describe_status() {
  if (($1 > 128)) && kill -l "$(($1 - 128))" >/dev/null 2>&1; then
    printf 'it was ended by SIG%s' "$(kill -l "$(($1 - 128))")"
  else
    printf 'it ended with status %s' "$1"
  fi
}

look_at_program() { # ID
  local id=$1 pid=${program[$1]-} status=0
  if [[ -n ${again_at[$id]-} ]]; then
    ((SECONDS >= again_at[$id])) || return 0
    again_at[$id]=''
    say again "$id"
    launch "$id"
    # A node with a life cycle begins anew: somebody has to bring it into its state again.
    if [[ ${state[$id]} == up && -n ${is_brought[$id]-} ]]; then
      become starting "$id"
      begin_patience "$id"
    fi
    [[ ${state[$id]} == up ]] || watch "$id"
    return
  fi
  [[ -n $pid ]] && ! kill -0 "$pid" 2>/dev/null || return 0
  wait "$pid" 2>/dev/null || status=$?
  if [[ ${kind[$id]} == once && $status == 0 ]]; then
    become ended "$id"
  elif [[ -n ${respawn[$id]-} ]]; then
    say ended "$id" "$(describe_status "$status"), and starts again in ${respawn[$id]} s"
    end_watcher "$id"
    end_processes "$id"
    again_at[$id]=$((SECONDS + $(round_up "${respawn[$id]}")))
  else
    fail "$id" "$(describe_status "$status")"
  fi
  [[ ${state[$id]} == failed ]] || program[$id]=''
}

look_at_signs() { # ID
  local id=$1 status=0 missing
  if [[ -n ${watcher[$id]-} ]]; then
    if kill -0 "${watcher[$id]}" 2>/dev/null; then
      missing=$(cat -- "$run/$id.missing" 2>/dev/null)
      if [[ -n ${deadline[$id]-} ]] && ((SECONDS >= deadline[$id])); then
        fail "$id" "not up within ${within[$id]} s: $missing"
      elif ((SECONDS >= told_at[$id] + 10)); then
        told_at[$id]=$SECONDS
        say waiting "$id" "$missing"
      fi
      return
    fi
    wait "${watcher[$id]}" 2>/dev/null || status=$?
    watcher[$id]=''
    if ((status != 0)); then
      fail "$id" "$(cat -- "$run/$id.missing" 2>/dev/null)"
      return
    fi
  elif [[ ${kind[$id]} == once ]]; then
    if [[ -n ${deadline[$id]-} ]] && ((SECONDS >= deadline[$id])); then
      fail "$id" "not at its end within ${within[$id]} s"
    fi
    return
  fi
  [[ -n ${again_at[$id]-} ]] || become up "$id"
}

look_at() { # ID
  case ${state[$1]} in
    planned) is_in_turn "$1" && is_free "$1" && begin "$1" ;;
    starting)
      look_at_program "$1"
      [[ ${state[$1]} != starting || (${kind[$1]} == elsewhere && $is_follower == yes && -z ${is_told[$1]-}) ]] || look_at_signs "$1"
      ;;
    up) look_at_program "$1" ;;
  esac
}

count_own_steps() {
  local id n=0
  for id in "${ids[@]}"; do [[ ${kind[$id]} == elsewhere ]] || n=$((n + 1)); done
  if ((n == 1)); then printf '1 step'; else printf '%s steps' "$n"; fi
}

# Goes on until something fails, somebody ends it, or nothing is left that runs.
bring_up() {
  local id running waiting idle=no
  while [[ -z $failure && -z $interrupt ]]; do
    find_open_phase
    running=0 waiting=0
    for id in "${ids[@]}"; do
      [[ -z $failure && -z $interrupt ]] || return
      look_at "$id"
      is_done "$id" || waiting=1
      [[ -z ${program[$id]-}${again_at[$id]-} ]] || running=1
    done
    if ((waiting == 0)) && [[ $announced == no ]]; then
      announced=yes
      say up all "$(count_own_steps), logs in $run"
      tell complete .
    fi
    if ((waiting + running == 0)); then
      [[ $is_follower == yes ]] || return
      [[ $idle == yes ]] || tell idle .
      idle=yes
    fi
    pause 0.2
  done
}
