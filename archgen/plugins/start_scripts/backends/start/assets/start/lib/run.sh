#!/usr/bin/env bash
# Becomes a program, after what it needs has been made ready.
#
#   run.sh [--settings FILE] [--set NAME=VALUE]... [--in FOLDER] [--by-line] [--copy FILE]
#          [--cpu N WORD...] [--fill] [--same NAME]... [--before N WORD...]... [--value NAME N WORD...]... -- WORD...
#
# --settings is read first, --before are N words that run to their end before, --value
# gives a parameter of ROS the output of N words (in ROS 1 its name begins with a slash). --by-line has the output written line by line, and
# --copy copies it to a file. --cpu are N words in front of its own, which give it a priority and cores; START_SCHEDULING=no leaves them out. --fill replaces $(find-pkg-share X), $(find X) and $(env X) in the values of parameters (behind -p, or of rosparam
# set), as launch files do. START_PREFIX (of settings.sh) stands in front of the names that the words of ROS bring, but for those of --same.
set -u

folder=. by_line=() cpu=() befores=() values=() fill='' same=' '
while (($#)); do
  case $1 in
    --settings)
      set +u
      # shellcheck source=/dev/null
      source "$2"
      set -u
      shift 2
      ;;
    --set) export "${2?}"; shift 2 ;;
    --in) folder=$2; shift 2 ;;
    --cpu) cpu=("${@:3:$2}"); shift $(($2 + 2)) ;;
    --by-line) by_line=(stdbuf -oL); shift ;;
    --copy)
      exec > >(exec tee -- "$2") 2>&1
      shift 2
      ;;
    --fill) fill=yes; shift ;;
    --same) same+="$2 "; shift 2 ;;
    --before) befores+=("$2" "${@:3:$2}"); shift $(($2 + 2)) ;;
    --value) values+=("$2" "$3" "${@:4:$3}"); shift $(($3 + 3)) ;;
    --) shift; break ;;
    *) printf 'run.sh: what is %q?\n' "$1" >&2; exit 2 ;;
  esac
done
# Sets `filled` to a text with its substitutions replaced: they stand in a string of YAML.
fill_in() { # TEXT
  local rest=$1 name value
  filled=''
  # Without quotes it is whatever its variable holds, as in launch files.
  if [[ $rest =~ ^([^\"]*:=)?\$\(env\ ([A-Za-z0-9_]+)\)$ ]]; then
    name=${BASH_REMATCH[2]}
    if [[ ${!name?} =~ ^(-?[0-9]+(\.[0-9]*)?|true|false)$ ]]; then
      filled=${rest%%"\$("*}${!name}
      return
    fi
    rest=${rest/"\$(env $name)"/\""\$(env $name)"\"}
  fi
  while [[ $rest =~ \$\((find-pkg-share|find|env)\ ([A-Za-z0-9_]+)\) ]]; do
    name=${BASH_REMATCH[2]}
    filled+=${rest%%"${BASH_REMATCH[0]}"*} rest=${rest#*"${BASH_REMATCH[0]}"}
    case ${BASH_REMATCH[1]} in
      find-pkg-share) value=$(ros2 pkg prefix --share "$name") || exit ;;
      find) value=$(rospack find "$name") || exit ;;
      env) value=${!name?} ;;
    esac
    value=${value//\\/\\\\}
    filled+=${value//\"/\\\"}
  done
  filled+=$rest
}

[[ $folder == /* ]] || folder=./$folder
cd -- "${START_FOLDER:-$(dirname -- "${BASH_SOURCE[0]}")/../..}" || exit
cd -- "$folder" || exit
words=("$@")
# A second robot: what is called /arm is /robot2/arm there.
if [[ -n ${START_PREFIX-} ]]; then
  place=''
  case ${words[*]:0:3} in
    'ros2 component load') words[3]=$START_PREFIX${words[3]} place=--node-namespace ;;
    'ros2 component standalone') place=--node-namespace ;;
    'ros2 run '*) place='-r __ns:=' ;;
    'rosrun nodelet nodelet') [[ ${words[3]} != load ]] || words[5]=$START_PREFIX${words[5]}; place=__ns:= ;;
    'rosrun '*) place=__ns:= ;;
  esac
  for ((i = 1; i < ${#words[@]}; i++)); do
    word=${words[i]}
    if [[ ${words[i - 1]} == --node-namespace ]]; then
      place='' words[i]=$START_PREFIX$word
    elif [[ $word == *:=/* && ($place == __ns:= || ${words[i - 1]} == -r) && $word != _[!_]* && $same != *" ${word#*:=} "* ]]; then
      [[ $word != __ns:=* ]] || place=''
      words[i]=${word%%:=*}:=$START_PREFIX${word#*:=}
    fi
  done
  case $place in
    '-r __ns:=') words+=(-r "__ns:=$START_PREFIX") ;;
    __ns:=) words+=("__ns:=$START_PREFIX") ;;
    ?*) words+=("$place" "$START_PREFIX") ;;
  esac
  for ((i = 3; i < ${#befores[@]}; i++)); do
    case "${befores[*]:i-2:2}|${befores[*]:i-3:2}" in
      'rosparam set|'*) [[ ${befores[i]} == /use_sim_time ]] || befores[i]=$START_PREFIX${befores[i]} ;;
      *'|rosparam load') befores[i]=$START_PREFIX${befores[i]} ;;
    esac
  done
  for ((i = 0; i < ${#values[@]}; i += ${values[i + 1]} + 2)); do
    [[ ${values[i]} != /* ]] || values[i]=$START_PREFIX${values[i]}
  done
fi
if [[ -n $fill ]]; then
  for ((i = 1; i < ${#words[@]}; i++)); do
    [[ ${words[i - 1]} != -p ]] || { fill_in "${words[i]}"; words[i]=$filled; }
  done
  for ((i = 3; i < ${#befores[@]}; i++)); do
    [[ ${befores[*]:i-3:2} != 'rosparam set' ]] || { fill_in "${befores[i]}"; befores[i]=$filled; }
  done
fi
set -- ${befores[@]+"${befores[@]}"}
while (($#)); do
  env -- "${@:2:$1}" || exit
  shift $(($1 + 1))
done
set -- ${values[@]+"${values[@]}"}
while (($#)); do
  value=$("${@:3:$2}") || exit
  # As a string of YAML, which is how ROS reads values.
  value=${value//\\/\\\\} value=${value//\"/\\\"} value=${value//$'\n'/\\n} value=${value//$'\t'/\\t} value=${value//$'\r'/\\r}
  if [[ $1 == /* ]]; then
    rosparam set "$1" "\"$value\"" || exit
  else
    words+=(-p "$1:=\"$value\"")
  fi
  shift $(($2 + 2))
done
[[ ${START_SCHEDULING-} != no ]] || cpu=()
exec -- ${cpu[@]+"${cpu[@]}"} ${by_line[@]+"${by_line[@]}"} "${words[@]}"
