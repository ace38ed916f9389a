#!/usr/bin/env bash
# Becomes a program, after what it needs has been made ready.
#
#   run.sh [--settings FILE] [--set NAME=VALUE]... [--in FOLDER] [--by-line] [--copy FILE]
#          [--before N WORD...]... [--value NAME N WORD...]... -- WORD...
#
# --settings is read first, --before are N words that run to their end before, --value
# gives a parameter of ROS the output of N words (in ROS 1 its name begins with a slash). --by-line has the output written line by line, and
# --copy copies it to a file.
set -u

folder=. by_line=() befores=() values=()
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
    --by-line) by_line=(stdbuf -oL); shift ;;
    --copy)
      exec > >(exec tee -- "$2") 2>&1
      shift 2
      ;;
    --before) befores+=("$2" "${@:3:$2}"); shift $(($2 + 2)) ;;
    --value) values+=("$2" "$3" "${@:4:$3}"); shift $(($3 + 3)) ;;
    --) shift; break ;;
    *) printf 'run.sh: what is %q?\n' "$1" >&2; exit 2 ;;
  esac
done
[[ $folder == /* ]] || folder=./$folder
cd -- "${START_FOLDER:-$(dirname -- "${BASH_SOURCE[0]}")/../..}" || exit
cd -- "$folder" || exit
words=("$@")
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
exec -- ${by_line[@]+"${by_line[@]}"} "${words[@]}"
