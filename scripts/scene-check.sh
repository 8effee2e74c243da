# Sourced by checks of scenes, as `. "$(dirname "$0")/scene-check.sh" NAME "$@"` where these get BUILD [--full]: goes to the tree's
# root, and says which build, whether in full, which folder is the check's own, and what a level is called.
set -euo pipefail
build=$(realpath "$2")
full=${3:-}
folder=$build/$1
cd "$(dirname "$0")/.."
mkdir -p "$folder"
level() { echo "pak1-maps.pk3:maps/$1.bsp"; }
