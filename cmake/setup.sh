# Sourced by ./run, ./check and .ci/run: installs missing packages, configures and builds. All of it may run again at no cost.
# Callers set `top` (the checkout) and are in it. Chatter goes to standard error.

export DEBIAN_FRONTEND=noninteractive
# ccache and CMake want a home; a bare container may have none.
if [ -z "${HOME:-}" ]; then
  export HOME=$top/build/home
  mkdir -p "$HOME"
fi

say() { printf '%s\n' "$*" >&2; }
die() { say "$@"; exit 1; }

# sudo may ask for a password on a terminal; elsewhere it must work without.
as_root() {
  if [ "$(id -u)" = 0 ]; then "$@"
  elif command -v sudo >/dev/null && { [ -t 2 ] || sudo -n true 2>/dev/null; }; then sudo DEBIAN_FRONTEND=noninteractive "$@"
  else die "${0##*/}: this needs root or sudo, once: apt-get install -y --no-install-recommends $missing"
  fi
}

install_packages() {
  local names
  names=$(sed 's/#.*//' cmake/packages.txt | xargs)
  if ! command -v dpkg-query >/dev/null; then
    [ -f build/release/build.ninja ] || say "${0##*/}: no dpkg here: install what cmake/packages.txt lists by hand if the build misses something"
    return 0
  fi
  # shellcheck disable=SC2086
  missing=$(comm -23 <(printf '%s\n' $names | LC_ALL=C sort) \
                     <(dpkg-query -W -f '${db:Status-Abbrev} ${Package}\n' $names 2>/dev/null | sed -n 's/^ii *//p' | LC_ALL=C sort) | xargs)
  [ -n "$missing" ] || return 0
  say "${0##*/}: installing $missing"
  local lock="-o DPkg::Lock::Timeout=600"
  # shellcheck disable=SC2086
  { as_root apt-get $lock -q update && as_root apt-get $lock -q -y --no-install-recommends install $missing; } </dev/null >&2 ||
    die "${0##*/}: apt-get failed (see above); needed: $missing"
}

# configure PRESET [OPTION...]
configure() {
  local dir=build/$1
  local preset=$1
  shift
  # A copied or moved checkout: CMake refuses a cache made elsewhere.
  if [ -f "$dir/CMakeCache.txt" ] && ! grep -qxF "CMAKE_HOME_DIRECTORY:INTERNAL=$top" "$dir/CMakeCache.txt"; then
    rm -rf "$dir"
  fi
  [ -f "$dir/build.ninja" ] && return 0
  say "${0##*/}: configuring $dir"
  locked cmake --preset "$preset" "$@" >&2 || die "${0##*/}: configuring failed (see above)"
}

# build PRESET TARGET...
build() {
  local dir=build/$1
  shift
  locked ninja -C "$dir" "$@" >&2 || die "${0##*/}: the build failed (see above)"
}

# build_quietly PRESET TARGET...: not a word, unless it fails.
build_quietly() {
  local log=build/$1.log
  (build "$@") 2>"$log" || { cat "$log" >&2; exit 1; }
}

# locked COMMAND...: one build at a time in this checkout.
locked() {
  mkdir -p build
  flock build/.lock "$@" </dev/null
}
