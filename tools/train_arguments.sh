# What the scripts train_* beside this file have in common. Each reads it first:
#   . "$(dirname "$0")/train_arguments.sh"
# which answers --help with the comment at the script's top, refuses wrong arguments before anything is
# made, and sets `ossa` to the command's whole path.

say_usage() { sed -n '2,/^[^#]/s/^# \{0,1\}//p' "$0"; }

# fail TEXT: one line, as ossa says it.
fail() {
  echo "$(basename "$0"): $*" >&2
  exit 1
}

# part_of CLIP: what a CMU clip, SUBJECT_NN.bvh, is for. Nobody is in two parts.
part_of() {
  case ${1##*/} in
    03_* | 07_* | 60_*) echo validation ;;
    02_* | 09_* | 12_*) echo test ;;
    *) echo train ;;
  esac
}

# clips_of FOLDER PART: its clips, a line each; none is a failure.
clips_of() {
  found=
  for clip in "$1"/*.bvh; do
    [ -e "$clip" ] && [ "$(part_of "$clip")" = "$2" ] || continue
    found=yes
    echo "$clip"
  done
  [ -n "$found" ] || fail "$1: expected clips of the $2 part, SUBJECT_NN.bvh, found none"
}

# link_clips FOLDER PART...: links to its clips of each part, in cmu30_PART. `ossa render` knows by that
# name whose terms they come with.
link_clips() {
  from=$1
  shift
  for part in "$@"; do
    clips=$(clips_of "$from" "$part")  # a failure ends the script
    mkdir -p "cmu30_$part"
    echo "$clips" | while IFS= read -r clip; do ln -sf "$clip" "cmu30_$part/"; done
  done
}

case ${1:-} in
  -h | --help)
    say_usage
    exit 0
    ;;
esac
if [ $# -lt 2 ] || [ $# -gt 3 ]; then
  say_usage >&2
  exit 2
fi
[ -d "$1" ] || fail "$1: expected a folder, found none"
ossa=${3:-$(dirname "$0")/../build/bin/ossa}
[ -n "$(command -v "$ossa")" ] ||
  fail "$ossa: expected the command, found none: build it, or name it as the third argument"
ossa=$(command -v "$ossa")
ossa=$(cd "$(dirname "$ossa")" && pwd)/$(basename "$ossa")
