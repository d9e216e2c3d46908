#!/bin/bash
# Tests packaging/farm/slurm on a real Slurm of one node: an array that draws 24 frames, and a
# picture of 3840x2160 in eight bands. In each, a task is killed in the middle and queued again. All
# files must be byte-identical to those that one process draws.
#
# It runs as root, takes some minutes, and is no part of `cargo test`: it needs the packages
# slurmctld, slurmd, slurm-client and munge of Debian or Ubuntu, and ports 16817 and 16818.
#
#   tests/farm/slurm.sh target/debug/sdfc
set -euo pipefail

SDFC=$(realpath "${1:?the program sdfc}")
export SDFC
here=$(cd "$(dirname "$0")" && pwd)
scripts=$here/../../packaging/farm/slurm
source "$here/one_node.sh"
work=$(mktemp -d)
trap 'stop_slurm; rm -rf "$work"' EXIT
start_slurm "$work/slurm"
cp "$here/scene.sdf" "$work"
cd "$work"
mkdir alone frames picture

fail() {
  echo "FAILED: $*" >&2
  tail -n 20 ./*.log slurm/log/* >&2
  exit 1
}

state_of() {
  scontrol --oneliner show job "$1" 2> /dev/null | sed -n 's/.*JobState=\([A-Z_]*\).*/\1/p'
}

is_running() { [[ $(state_of "$1") == RUNNING ]]; }
is_completed() { [[ $(state_of "$1" | sort -u) == COMPLETED ]]; }

# has_files FOLDER COUNT: a folder has at least this many files.
has_files() { (($(find "$1" -type f -name '[!.]*' | wc -l) >= $2)); }

is_failed() { [[ $(state_of "$1") == FAILED ]]; }

# Kills the program of a task, as a machine without memory does.
kill_task() {
  local process
  for process in $(pgrep -x sdfc); do
    if grep -qz "SLURM_ARRAY_TASK_ID=$1\$" "/proc/$process/environ" 2> /dev/null; then
      kill -KILL "$process"
      return 0
    fi
  done
  return 1
}

echo "one process draws everything"
size=(--size 480x270 --backend cpu)
large=(--size 3840x2160 --backend cpu)
"$SDFC" render scene.sdf --output alone/frame.png --frames 0..24 "${size[@]}"
"$SDFC" render scene.sdf --output alone/large.png "${large[@]}"

echo "an array draws 24 frames; a task is killed after its first frame"
array=$(sbatch --parsable --array=1-3 "$scripts/frames.sbatch" 3 scene.sdf frames/frame.png 0..24 \
  "${size[@]}")
wait_for 60 has_files frames 2
wait_for 10 kill_task 2
wait_for 60 is_failed "${array}_2" || fail "the killed task has not failed"
scontrol requeue "${array}_2"
wait_for 300 is_completed "$array" || fail "the array does not end"
for file in alone/frame.*.png; do
  cmp "$file" "frames/${file#alone/}" || fail "$file differs"
done
[[ $(find frames -name '[!.]*.png' | wc -l) == 24 ]] || fail "there are other files in frames"
grep -q '"state":"skipped"' "sdfc-frames-${array}_2.log" || fail "no finished frame was skipped"
echo "24 frames are identical; task 2 ran $(grep -c 'drawn on' "sdfc-frames-${array}_2.log") time(s) \
to its end and skipped $(grep -c '"state":"skipped"' "sdfc-frames-${array}_2.log") finished frame(s)"

echo "an array draws a picture in eight bands; a task is killed in the middle"
read -r bands join < <("$scripts/picture.sh" 8 scene.sdf picture/large.png "${large[@]}")
wait_for 60 is_running "${bands}_1"
wait_for 60 kill_task 1
wait_for 300 is_failed "$join" || fail "a part is missing, and the picture was joined"
grep -q 'a part is missing: draw it with --region 0,0,' "sdfc-join-$join.log" || fail "no reason"
scontrol requeue "${bands}_1"
wait_for 300 is_completed "$bands" || fail "the array does not end"
scontrol requeue "$join"
wait_for 60 is_completed "$join" || fail "the bands are not joined"
cmp alone/large.png picture/large.png || fail "the joined picture differs"
echo "the joined picture is identical: $(sha256sum < picture/large.png)"
