#!/bin/bash
# Submits a picture: an array of tasks that draw bands of rows, and a job that joins the bands when
# all tasks have ended. If a task has failed, that job fails too and says which region is missing.
# Prints the numbers of both jobs.
#
#   picture.sh 8 scene.sdf picture/large.png --size 3840x2160
set -euo pipefail

if (($# < 3)); then
  echo "usage: picture.sh BANDS SCENE OUTPUT [OPTION]..." >&2
  exit 2
fi
here=$(cd "$(dirname "$0")" && pwd)
bands=$(sbatch --parsable --array="1-$1" "$here/bands.sbatch" "$@")
join=$(sbatch --parsable --dependency="afterany:$bands" "$here/join.sbatch" "$3")
echo "$bands $join"
