# Sourced by check-bare.sh and check-demo.sh: a bare Debian 12 with this tree in /sightline, as $root. As root, with
# mmdebstrap installed.

# make_bare [PACKAGE…]: a Debian 12 with these packages and no other.
make_bare() {
  root=$(mktemp -d)
  trap 'rm -rf "$root"' EXIT
  chmod 755 "$root"
  mmdebstrap --variant=apt --mode=root --quiet --aptopt='APT::Install-Recommends "false"' \
    ${1:+--include="$(IFS=,; echo "$*")"} bookworm "$root" "${DEBIAN_MIRROR:-http://deb.debian.org/debian}"
  cp /etc/resolv.conf "$root/etc/resolv.conf"
  # Of a network that has certificates of its own.
  [ ! -d /usr/local/share/ca-certificates ] || cp -r /usr/local/share/ca-certificates "$root/usr/local/share/"
  mkdir "$root/sightline"
  git archive HEAD | tar -x -C "$root/sightline"
}

# in_bare COMMAND…: runs it there, in a mount namespace of its own, so that no mount is left behind.
in_bare() {
  unshare --mount sh -ec 'mount -t proc proc "$1/proc"; exec chroot "$@"' sh "$root" "$@"
}

# within MOST WHAT SECONDS: says how long it took, also in the file $MEASURED, and fails where that is too long.
within() {
  [ -z "${MEASURED:-}" ] || echo "$3" >"$MEASURED"
  echo "$2: $3 s"
  [ "$3" -le "$1" ] || { echo "expected at most $1 s"; exit 1; }
}
