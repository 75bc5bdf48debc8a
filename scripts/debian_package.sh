#!/usr/bin/env bash
# Makes Debian packages of this tree: the tool, the library, and what programs are built with: debian_package.sh [FOLDER], build/debian unless told.
# Wants debhelper (scripts/setup.sh debian). The version is the header's.
set -euo pipefail
cd "$(dirname "$0")/.."
mkdir -p "${1:-build/debian}"
out=$(cd "${1:-build/debian}" && pwd)
version=$(sed -n 's/^#define BP_VERSION "\(.*\)"/\1/p' src/brdfpack.h)
tree=$(mktemp -d)
trap 'rm -rf "$tree"' EXIT
mkdir "$tree/brdfpack-$version"
cp -r Makefile src scripts manifests tests README.md "$tree/brdfpack-$version"
cd "$tree/brdfpack-$version"
mv scripts/debian debian
mkdir debian/source
echo "3.0 (native)" >debian/source/format
# the day of the last change, so that the same tree gives the same package
day=$(git -C "$OLDPWD" log -1 --format=%cD 2>/dev/null || date -R)
printf 'brdfpack (%s) unstable; urgency=medium\n\n  * The tree as it is.\n\n -- brdfpack developers <brdfpack@example.org>  %s\n' "$version" "$day" >debian/changelog
printf 'Format: https://www.debian.org/doc/packaging-manuals/copyright-format/1.0/\n\nFiles: *\nCopyright: 2026 the brdfpack developers\nLicense: unspecified\n The tree has no licence file: ask its developers.\n' >debian/copyright
dpkg-buildpackage --build=binary --no-sign
mv "$tree"/*.deb "$out"
