#!/usr/bin/env bash
# Becomes a program, after what it needs has been made ready.
#
#   run.sh [--settings FILE] [--set NAME=VALUE]... [--in FOLDER] [--by-line] [--copy FILE] [--before N WORD...]... -- WORD...
#
# --settings is read first, --before are N words that run to their end before, --by-line has the output written line by line, and
# --copy copies it to a file.
set -u

folder=. by_line=() befores=()
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
exec -- ${by_line[@]+"${by_line[@]}"} "${words[@]}"
