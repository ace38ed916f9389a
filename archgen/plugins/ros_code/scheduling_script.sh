#!/bin/sh
# Starts a program with the priority and on the cores of the architecture, as far as this computer allows it. Made by archgen.
# Usage: this script, [chrt -f PRIORITY] [taskset -c CORES] -- PROGRAM [WORD]...
allowed='' refused=''
while [ "$1" != -- ]; do
  words="$1 $2 $3"
  shift 3
  # shellcheck disable=SC2086 # These are words.
  if reason=$($words true 2>&1); then
    allowed="$allowed $words"
  else
    refused="${refused}starts without \"$words\", and no bound of archgen holds: $reason
"
  fi
done
shift
printf '%s' "$refused" | while read -r line; do
  printf '%s %s\n' "${1##*/}" "$line" >&2
done
# shellcheck disable=SC2086 # These are words.
exec $allowed "$@"
