# shellcheck shell=bash disable=SC2154,SC2034 # engine.sh has the other variables
# How the programs of steps are started, watched and ended. Each is a group of processes of its own, and carries a mark in
# its environment, by which whatever it started is found, too.

declare -A program=() watcher=() older_bytes=() stopped=()

# Words in front of a command that is to run as the user of a step.
find_user_words() { # ID
  user_words=()
  [[ -n ${user[$1]-} && ${user[$1]} != "$(id -un)" ]] || return 0
  if ((EUID == 0)); then
    user_words=(runuser -u "${user[$1]}" --)
  else
    user_words=(sudo -n -u "${user[$1]}" --)
  fi
}

# Scripts of several computers may run on one: what one of them watches of another is its own.
mark() { # ID
  local watching=''
  [[ ${kind[$1]} != elsewhere ]] || watching=@$host
  printf 'START_STEP=%s:%s%s' "$run" "$1" "$watching"
}

# The words that become the program of a step, in its folder and with its variables.
find_run_words() { # ID
  local variable user_words
  local -n its_words=words_${number[$1]} its_variables=variables_${number[$1]} its_before=before_${number[$1]}
  local -n its_signs=signs_${number[$1]}
  find_user_words "$1"
  run_words=(${user_words[@]+"${user_words[@]}"} bash "$library/run.sh")
  # Another user has none of the variables that were set here.
  ((${#user_words[@]} == 0)) || [[ ! -f $settings ]] || run_words+=(--settings "$settings")
  for variable in "START_FOLDER=$START_FOLDER" PYTHONUNBUFFERED=1 ${its_variables[@]+"${its_variables[@]}"} "$(mark "$1")"; do
    run_words+=(--set "$variable")
  done
  run_words+=(--in "${directory[$1]:-.}" ${its_before[@]+"${its_before[@]}"})
  # Who waits for words of its output wants to see them at once.
  [[ " ${its_signs[*]-} " != *' --log '* ]] || run_words+=(--by-line)
  run_words+=(-- "${its_words[@]}")
}

launch() { # ID
  local run_words output=$run/${log[$1]}
  : >>"$output"
  older_bytes[$1]=$(stat -c %s -- "$output")
  find_run_words "$1"
  set -m
  (
    exec {never}>&- {guarded}>&- {locked}>&-
    exec -- "${run_words[@]}"
  ) </dev/null >>"$output" 2>&1 &
  program[$1]=$!
  set +m
}

start_watcher() { # ID WORD...
  local id=$1
  shift
  set -m
  (
    exec {never}>&- {guarded}>&- {locked}>&-
    export "$(mark "$id")"
    exec bash "$library/wait_until_up.sh" --missing "$run/$id.missing" "$@"
  ) </dev/null >>"$run/${log[$id]}" 2>&1 &
  watcher[$id]=$!
  set +m
}

watch() { # ID
  local -n its_signs=signs_${number[$1]}
  local run_words=()
  ((${#its_signs[@]})) || return 0
  [[ ${kind[$1]} != loaded ]] || find_run_words "$1"
  start_watcher "$1" --output "$run/${log[$1]}" "${older_bytes[$1]:-0}" "${its_signs[@]}" \
    ${run_words[@]+-- "${run_words[@]}"}
}

# A step of another computer, while no script above says how it goes: what can be seen from here is waited for.
watch_from_afar() { # ID
  local -n its_signs=signs_${number[$1]}
  local i seen=() kinds='^--(port|topic|service)$'
  [[ ${host_of[$1]} != "$host" ]] || kinds='^--(port|topic|service|file)$'
  for ((i = 0; i < ${#its_signs[@]}; i += 2)); do
    [[ ! ${its_signs[i]} =~ $kinds ]] || seen+=("${its_signs[@]:i:2}")
  done
  if ((${#seen[@]})); then
    start_watcher "$1" --address "${address[${host_of[$1]}]}" "${seen[@]}"
  else
    say unseen "$1" "from here nobody sees whether it is up; start ${host_of[$1]} first"
  fi
}

# Finds the processes of a step that still run: those of its groups, and those that carry its mark.
find_processes() { # ID
  local user_words marked
  found=()
  if kill -0 -- "-${program[$1]:-none}" 2>/dev/null; then
    # What has ended and waits for its parent does not run any more.
    mapfile -t found < <(cat /proc/[0-9]*/stat 2>/dev/null | awk -v group="${program[$1]}" \
      '{ pid = $1; sub(/^.*\) /, ""); if ($1 != "Z" && $1 != "X" && $3 == group) print pid }')
  fi
  find_user_words "$1"
  mapfile -t marked < <(${user_words[@]+"${user_words[@]}"} grep -lszFx -e "$(mark "$1")" /proc/[0-9]*/environ)
  found+=("${marked[@]//[!0-9]/}")
  ((${#found[@]}))
}

send() { # SIGNAL ID PID...
  local signal=$1 user_words
  find_user_words "$2"
  ${user_words[@]+"${user_words[@]}"} kill -s "$signal" -- "${@:3}" 2>/dev/null
}

end_watcher() { # ID
  [[ -n ${watcher[$1]-} ]] || return 0
  kill -s KILL -- "-${watcher[$1]}" 2>/dev/null
  wait "${watcher[$1]}" 2>/dev/null
  watcher[$1]=''
}

# Interrupts what still runs of a step; terminates and at last kills what does not end by itself.
end_processes() { # ID
  local signal until found
  find_processes "$1" || return 0
  for signal in INT TERM KILL; do
    [[ $signal != KILL ]] || say killing "$1" 'it does not end by itself'
    send "$signal" "$1" "${found[@]}"
    until=$((SECONDS + patience))
    while ((SECONDS <= until)); do
      find_processes "$1" || return 0
      read -r -t 0.1 -u "$never" || true
    done
  done
  say left "$1" "these processes could not be ended: ${found[*]}"
  left_over=yes
}

stop_step() { # ID
  local id=$1
  [[ -z ${stopped[$id]-} && ${state[$id]} != planned && ${state[$id]} != skipped ]] || return 0
  stopped[$id]=yes
  end_watcher "$id"
  end_processes "$id"
  [[ -z ${program[$id]-} || ${state[$id]} == failed ]] || say stopped "$id"
  wait "${program[$id]:-$$}" 2>/dev/null
}
