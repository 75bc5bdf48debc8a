#!/usr/bin/env bash
# Installs into a scratch folder and uses what is there as another program would: tests/install.sh BUILD [MAKE-VARIABLE]...
set -euo pipefail
cd "$(dirname "$0")/.."
build=$1
shift
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
make=(make -s "BUILD=$build" "$@")

"${make[@]}" check-symbols
"${make[@]}" install "PREFIX=$scratch/usr" >/dev/null
"${make[@]}" install "PREFIX=/usr" "DESTDIR=$scratch/image" >/dev/null
(cd "$scratch/usr" && find . ! -type d | sort) >"$scratch/plain"
(cd "$scratch/image/usr" && find . ! -type d | sort) >"$scratch/staged"
cmp "$scratch/plain" "$scratch/staged"
cat "$scratch/plain"

# the loader is told, but not of an image that is for another place
"${make[@]}" -n install "PREFIX=$scratch/usr" | grep -q ldconfig
if "${make[@]}" -n install "DESTDIR=$scratch/image" | grep ldconfig; then exit 1; fi

export PKG_CONFIG_PATH=$scratch/usr/lib/pkgconfig LD_LIBRARY_PATH=$scratch/usr/lib
archive=$scratch/demo.bpk
"$scratch/usr/bin/brdfpack" synth --lattice 6x6x8 "$scratch/materials"
"$scratch/usr/bin/brdfpack" build -q --any-lattice -o "$archive" "$scratch/materials"
count=$(find "$scratch/materials" -name "*.binary" | wc -l)

# what lets tests crash a worker is in no build that does not ask for it
cc -std=c17 -D_GNU_SOURCE -Isrc -c -o "$scratch/work.o" src/tool/build/build_work.c
if grep -q BRDFPACK_TEST "$scratch/work.o"; then
	echo "test switches in an ordinary build"
	exit 1
fi
flags=(-Wall -Wextra -Werror)
read -r -a shared <<<"$(pkg-config --cflags --libs brdfpack)"
read -r -a static <<<"$(pkg-config --static --cflags --libs brdfpack)"
cc -std=c17 "${flags[@]}" -o "$scratch/shared" tests/consumer.c "${shared[@]}"
cc -std=c17 "${flags[@]}" -static -o "$scratch/static" tests/consumer.c "${static[@]}"
[ "$("$scratch/shared" "$archive")" = "$count" ]
[ "$("$scratch/static" "$archive")" = "$count" ]
# the library's own answer to which version it is
printf '#include <brdfpack.h>\n#include <stdio.h>\nint main(void) { printf("%%s %%d\\n", bp_version_text(), bp_version() == BP_VERSION_NUMBER); return 0; }\n' >"$scratch/version.c"
cc -std=c17 "${flags[@]}" -o "$scratch/version" "$scratch/version.c" "${shared[@]}"
[ "$("$scratch/version")" = "$(pkg-config --modversion brdfpack) 1" ]
if command -v g++ >/dev/null; then
	g++ -x c++ "${flags[@]}" -o "$scratch/cpp" tests/consumer.c "${shared[@]}"
	[ "$("$scratch/cpp" "$archive")" = "$count" ]
fi
# the documentation's example draws a sphere: 160 x 160 pixels, and not all alike
cc -std=c17 "${flags[@]}" -O2 -o "$scratch/sphere" format-spec/example/sphere.c "${shared[@]}" -lm
"$scratch/sphere" "$archive" "$("$scratch/usr/bin/brdfpack" list --json "$archive" | sed -n '1s/.*"name": "\([^"]*\)".*/\1/p')" "$scratch/sphere.ppm"
[ "$(wc -c <"$scratch/sphere.ppm")" = $((15 + 3 * 160 * 160)) ]
[ "$(tail -c +16 "$scratch/sphere.ppm" | od -An -v -tu1 -w3 | sort -u | wc -l)" -gt 100 ]
if "$scratch/sphere" "$archive" no-such-material "$scratch/none.ppm" 2>/dev/null; then exit 1; fi
# nothing but zlib, libm and libc at run time
needed=$(readelf -d "$scratch/usr/lib/libbrdfpack.so" | sed -n 's/.*NEEDED.*\[\(.*\)\]/\1/p' | grep -v '^libz\.\|^libm\.\|^libc\.\|^ld-linux' || true)
[ -z "$needed" ] || { echo "libbrdfpack needs $needed"; exit 1; }
readelf -d "$scratch/usr/lib/libbrdfpack.so" | grep -q "SONAME.*libbrdfpack.so.0"

# CMake finds it, also after the tree has moved
if command -v cmake >/dev/null; then
	mkdir "$scratch/cmake"
	cp tests/consumer.c "$scratch/cmake"
	cat >"$scratch/cmake/CMakeLists.txt" <<-'END'
		cmake_minimum_required(VERSION 3.16)
		project(consumer C)
		find_package(brdfpack 0.2 REQUIRED)
		foreach(kind brdfpack static reader)
			add_executable(with_${kind} consumer.c)
			target_link_libraries(with_${kind} brdfpack::${kind})
		endforeach()
	END
	cp -r "$scratch/usr" "$scratch/moved"
	for place in usr moved; do
		cmake -S "$scratch/cmake" -B "$scratch/cmake-$place" -DCMAKE_PREFIX_PATH="$scratch/$place" >"$scratch/log" || { cat "$scratch/log"; exit 1; }
		cmake --build "$scratch/cmake-$place" >"$scratch/log" || { cat "$scratch/log"; exit 1; }
		for kind in brdfpack static reader; do
			[ "$(env -u LD_LIBRARY_PATH "$scratch/cmake-$place/with_$kind" "$archive")" = "$count" ]
		done
	done
	! grep -r "$scratch/usr" "$scratch/cmake-moved" >/dev/null
	sed -i 's/brdfpack 0.2/brdfpack 0.1/' "$scratch/cmake/CMakeLists.txt"
	if cmake -S "$scratch/cmake" -B "$scratch/cmake-old" -DCMAKE_PREFIX_PATH="$scratch/usr" >/dev/null 2>&1; then exit 1; fi
fi

# completions say what the program's help says
completed() { # completed WORD...: what bash offers for the last of them
	PATH=$scratch/usr/bin:$PATH bash -c '. "$1/share/bash-completion/completions/brdfpack"; shift; COMP_WORDS=("$@"); COMP_CWORD=$(($# - 1)); _brdfpack; printf "%s\n" "${COMPREPLY[@]}"' \
		bash "$scratch/usr" brdfpack "$@"
}
[ "$(completed v)" = verify ]
[ "$(completed build --ma | sort | tr '\n' ' ')" = "--manifest --max-error " ]
[ "$(completed list -h)" = -h ]
[ "$(completed extract "$archive" wine)" = wine-velvet ]
[ "$(completed "" | wc -l)" -ge 14 ]
if command -v zsh >/dev/null; then zsh -n scripts/completions/_brdfpack; fi
if command -v fish >/dev/null; then fish --no-execute scripts/completions/brdfpack.fish; fi

"${make[@]}" uninstall "PREFIX=$scratch/usr" >/dev/null
[ -z "$(find "$scratch/usr" ! -type d)" ]
