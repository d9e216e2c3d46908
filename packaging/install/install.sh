#!/bin/sh
# Installs sdfc from the archive of a release: programs, manual pages and completions.
#
#   curl -fsSL https://github.com/sdfc/sdfc/releases/latest/download/install.sh | sh
#
# SDFC_VERSION  the release; the default is the one that this script belongs to
# SDFC_PREFIX   the folder that gets bin and share; the default is ~/.local
# SDFC_URL      the address of the folder with the archives
#
# Needs curl or wget, tar, and sha256sum or shasum. Another run replaces what this one has written.
set -eu

# `packaging/install/release` writes the version.
version=${SDFC_VERSION:-unreleased}

fail() {
  echo "install.sh: $1" >&2
  exit 1
}

has() { command -v "$1" > /dev/null 2>&1; }

# Prints the target of this machine's archive.
target() {
  case $(uname -s)-$(uname -m) in
    Linux-x86_64) echo x86_64-unknown-linux-gnu ;;
    Linux-aarch64 | Linux-arm64) echo aarch64-unknown-linux-gnu ;;
    Darwin-arm64) echo aarch64-apple-darwin ;;
    *) fail "there is no archive for $(uname -s) on $(uname -m); build sdfc from its source, as its README says" ;;
  esac
}

# Downloads the address $1 into the file $2.
download() {
  if has curl; then
    curl -fsSL --retry 2 -o "$2" "$1"
  elif has wget; then
    wget -q -O "$2" "$1"
  else
    fail "curl and wget are missing; install one of them"
  fi || fail "$1 cannot be downloaded; check the version and the connection"
}

# Checks the file $1 in this folder by the file $1.sha256.
check() {
  if has sha256sum; then
    sha256sum --check --status "$1.sha256"
  elif has shasum; then
    shasum -a 256 --check --status "$1.sha256"
  else
    fail "sha256sum and shasum are missing; install one of them"
  fi || fail "$1 has another checksum than the release states; nothing was installed"
}

# Copies the file $2 to $3 below the prefix, with the mode $1. The new file replaces the old one as a
# whole, also while the old program runs.
put() {
  mkdir -p "$prefix/$(dirname "$3")"
  cp "$2" "$prefix/$3.new"
  chmod "$1" "$prefix/$3.new"
  mv -f "$prefix/$3.new" "$prefix/$3"
}

# A function, so that a script that is cut off while it is downloaded does nothing.
main() {
  [ "$version" != unreleased ] || fail "this script belongs to no release; set SDFC_VERSION, such as 0.1.0"
  prefix=${SDFC_PREFIX:-${HOME:?}/.local}
  name=sdfc-$version-$(target)
  url=${SDFC_URL:-https://github.com/sdfc/sdfc/releases/download/v$version}

  work=$(mktemp -d)
  trap 'rm -rf "$work"' EXIT
  trap 'exit 1' HUP INT TERM
  cd "$work"
  download "$url/$name.tar.gz" "$name.tar.gz"
  download "$url/$name.tar.gz.sha256" "$name.tar.gz.sha256"
  check "$name.tar.gz"
  tar xzf "$name.tar.gz"
  cd "$name"
  ./sdfc --version > /dev/null || fail "sdfc does not run here; docs/releasing.md says what the archive needs"

  # The viewer lies beside the command line, which starts it.
  put 755 sdfc-view bin/sdfc-view
  put 755 sdfc bin/sdfc
  for page in man/man1/*.1; do
    put 644 "$page" "share/$page"
  done
  put 644 completions/sdfc.bash share/bash-completion/completions/sdfc
  put 644 completions/_sdfc share/zsh/site-functions/_sdfc
  put 644 completions/sdfc.fish share/fish/vendor_completions.d/sdfc.fish
  for file in LICENSE-APACHE LICENSE-MIT LICENSES-LIBRARIES.txt; do
    put 644 "$file" "share/doc/sdfc/$file"
  done

  echo "sdfc $version is in $prefix/bin"
  case :$PATH: in
    *:"$prefix/bin":*) ;;
    *) echo "Add that folder to PATH, such as by: export PATH=\"$prefix/bin:\$PATH\"" ;;
  esac
}

main
