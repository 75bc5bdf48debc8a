#!/usr/bin/env bash
# Installs the Debian packages that are missing, and nothing that is already there.
#
#     scripts/setup.sh [build|test|slow|slurm|arm64|endian|mitsuba|debian|bench|viewer]...      default: build
#
#     build  what the tool and the library need
#     test   what the unit tests (also those of the benchmark) and command-line tests need besides
#     slow   what the clang, sanitizer and valgrind jobs need besides
#     slurm  what the job on Slurm needs besides
#     arm64  what the unit tests on ARM64, cross-compiled, need: adds that architecture to dpkg
#     endian what the reader's tests on big-endian machines need: two cross compilers and qemu
#     mitsuba  what the job with Mitsuba 3 needs besides
#     debian  what makes and checks the Debian packages
#     bench  what the benchmarks and their plots need besides
#     viewer what the page's viewer is built with, and the browser that tests it
#
# Needs root or sudo only when something is missing; without either it names the packages and stops.
set -euo pipefail

# package:command, where any version of the command will do, however it was installed
build="gcc:gcc make:make libc6-dev zlib1g-dev libarchive-dev nettle-dev libpng-dev"
test="clang-format-14:clang-format-14 libc6-dev-i386 lib32gcc-12-dev libcmocka-dev libgsl-dev python3:python3 python3-dev python3-venv pkg-config:pkg-config cmake:cmake liblapacke-dev libzfp-dev libzstd-dev liblzma-dev"
slow="clang:clang libclang-rt-14-dev valgrind:valgrind g++:g++"
slurm="slurm-wlm munge"
# not gcc-aarch64-linux-gnu, which gcc-multilib excludes
arm64="gcc-12-aarch64-linux-gnu qemu-user:qemu-aarch64 libc6-dev=arm64 zlib1g-dev=arm64 libcmocka-dev=arm64 libarchive-dev=arm64 nettle-dev=arm64 libpng-dev=arm64"
endian="gcc-12-s390x-linux-gnu libc6-dev-s390x-cross gcc-12-mips-linux-gnu libc6-dev-mips-cross qemu-user:qemu-s390x"
mitsuba="libllvm19"
debian="dpkg-dev debhelper lintian"
bench="gnuplot-nox:gnuplot python3:python3 libgsl-dev liblapacke-dev libzfp-dev libzstd-dev liblzma-dev"
viewer="emscripten:emcc nodejs:node chromium:chromium python3:python3"

groups="build test slow slurm arm64 endian mitsuba debian bench viewer"
wanted=""
for group in "${@:-build}"; do
	if [[ " $groups " != *" $group "* ]]; then
		echo "setup.sh: unknown group '$group'; groups are ${groups// /, }" >&2
		exit 2
	fi
	wanted+=" ${!group}"
done

missing=()
for entry in $wanted; do
	package=${entry%%:*}
	command=""
	[ "$entry" = "$package" ] || command=${entry#*:}
	package=${package/=/:} # of another architecture, as dpkg has it
	[ -z "$command" ] || ! command -v "$command" >/dev/null 2>&1 || continue
	# a line for each architecture that has it
	dpkg-query -W -f='${db:Status-Status}\n' "$package" 2>/dev/null | grep -qx installed || missing+=("$package")
done
[ ${#missing[@]} -gt 0 ] || exit 0

as_root=()
if [ "$(id -u)" != 0 ]; then
	# sudo without a password, or someone at a terminal who can type one
	if ! command -v sudo >/dev/null 2>&1 || ! { sudo -n true 2>/dev/null || [ -t 0 ]; }; then
		echo "setup.sh: these packages are missing, and installing them needs root or sudo:" >&2
		echo "    apt-get install ${missing[*]}" >&2
		exit 1
	fi
	as_root=(sudo)
fi
if ! command -v apt-get >/dev/null 2>&1; then
	echo "setup.sh: no apt-get here; install what these Debian packages hold: ${missing[*]}" >&2
	exit 1
fi
echo "setup.sh: installing ${missing[*]}"
log=$(mktemp)
trap 'rm -f "$log"' EXIT
if [[ " ${missing[*]} " == *:arm64\ * ]]; then "${as_root[@]}" dpkg --add-architecture arm64 || exit 1; fi
if ! { "${as_root[@]}" apt-get update -qq &&
	"${as_root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get install -y -qq --no-install-recommends "${missing[@]}"; } >"$log" 2>&1; then
	tail -n 20 "$log" >&2
	echo "setup.sh: apt-get failed" >&2
	exit 1
fi
