# Common code of the scripts train_* in this folder. Each reads it first:
#   . "$(dirname "$0")/train_arguments.sh"
# It prints the comment at the script's top for --help, refuses wrong arguments before anything is
# written, and sets `ossa` to the absolute path of the command.

print_usage() { sed -n '2,/^[^#]/s/^# \{0,1\}//p' "$0"; }

# fail TEXT: prints one line, as ossa does, and exits.
fail() {
  echo "$(basename "$0"): $*" >&2
  exit 1
}

# part_of CLIP: the part of a CMU clip, SUBJECT_NN.bvh. Each subject is in one part only.
part_of() {
  case ${1##*/} in
    03_* | 07_* | 60_*) echo validation ;;
    02_* | 09_* | 12_*) echo test ;;
    *) echo train ;;
  esac
}

# clips_of FOLDER PART: its clips, one per line; fails without any.
clips_of() {
  found=
  for clip in "$1"/*.bvh; do
    [ -e "$clip" ] && [ "$(part_of "$clip")" = "$2" ] || continue
    found=yes
    echo "$clip"
  done
  [ -n "$found" ] || fail "$1: expected clips of the $2 part, SUBJECT_NN.bvh, found none"
}

# link_clips FOLDER PART...: links to its clips of each part, in cmu30_PART. `ossa render` recognises by
# that name that CMU's terms apply.
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
    print_usage
    exit 0
    ;;
esac
if [ $# -lt 2 ] || [ $# -gt 3 ]; then
  print_usage >&2
  exit 2
fi
[ -d "$1" ] || fail "$1: expected a folder, found none"
ossa=${3:-$(dirname "$0")/../build/bin/ossa}
[ -n "$(command -v "$ossa")" ] ||
  fail "$ossa: expected the command, found none: build it, or name it as the third argument"
ossa=$(command -v "$ossa")
ossa=$(cd "$(dirname "$ossa")" && pwd)/$(basename "$ossa")
