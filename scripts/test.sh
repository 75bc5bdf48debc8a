#!/usr/bin/env bash
# Installs what is missing, builds, runs test jobs, prints totals.
#
#     scripts/test.sh [JOB]...
#
#     house     the plan of src: which wing may include which, that the map is true, and the sources' form
#     unit      unit tests, built by gcc with warnings as errors
#     cli       command-line tests (tests/cli)
#     portable  the reading half: what it links, and its values without the system, on 32 bits and on big-endian machines
#     install   installs into a scratch folder; symbols; a consumer built through pkg-config
#     python    the independent Python reader against the C library
#     package   the Python package in a clean virtual environment (skipped where pip reaches no index)
#     mitsuba   Mitsuba 3, which pip fetches: the plugin, and exported files in its own `measured` (when named; skipped where pip cannot)
#     debian    Debian packages of the tree, and lintian (when named)
#     asan      unit and command-line tests with AddressSanitizer and UBSan
#     clang     builds everything by clang with warnings as errors; and the libraries by both with -flto
#     valgrind  a small build, list, extract and verify under valgrind
#     pinned    bytes, errors and decoded values of the demo materials against tests/pinned.tsv
#     stress    adversarial materials through every profile (the short form of `make stress`)
#     faults    damaged archives, killed and starved builds, threads (the short form of `make faults`)
#     bench     the benchmark programs on small tables: they run, and their tables and plots are whole
#     slurm     shards as an array job on Slurm, on this machine alone (in continuous integration, or when named)
#     arm64     unit tests on ARM64, cross-compiled and run under qemu (when named)
#     viewer    the report and its viewer: the WebAssembly reader in Node, the page in Chromium (when named; installs these, or says that it was skipped)
#     fuzz      each fuzz target for some seconds
#
# Without a JOB: all of them, but for what is said above. First everything they need is built, then the jobs run, as many at once as there are
# cores, each printing what it has to say when it ends. The last line is "N passed, M failed"; the exit code is 1 when M > 0.
set -uo pipefail
cd "$(dirname "$0")/.." || exit 1

# in the order they start: the longest first
all_jobs="asan faults fuzz python stress unit pinned package cli bench install portable valgrind clang house"
in_ci="slurm"
on_request="viewer arm64 mitsuba debian"
logs=build/logs
passed=0
failed=0

for job in "$@"; do
	case " $all_jobs $in_ci $on_request " in
	*" $job "*) ;;
	*)
		echo "test.sh: unknown job '$job'; jobs are $all_jobs $in_ci $on_request" >&2
		exit 2
		;;
	esac
done
jobs=""
for job in $all_jobs $in_ci $on_request; do
	if { [ $# = 0 ] && { [[ " $all_jobs " == *" $job "* ]] || { [ -n "${CI:-}" ] && [[ " $in_ci " == *" $job "* ]]; }; }; } || [[ " $* " == *" $job "* ]]; then jobs+=" $job"; fi
done
# does any of these jobs run?
wanted() {
	local job
	for job in "$@"; do [[ "$jobs " != *" $job "* ]] || return 0; done
	return 1
}

groups="build test"
if wanted asan clang valgrind faults fuzz; then groups+=" slow"; fi
# shellcheck disable=SC2086
scripts/setup.sh $groups || exit 1
rm -rf "$logs" && mkdir -p "$logs"
cores=$(nproc)
lanes=$(wc -w <<<"$jobs")
[ "$lanes" -le "$cores" ] || lanes=$cores
width=$((cores / lanes)) # the cores that a job may use

# Runs make and keeps what came of it for the jobs: prepare NAME MAKE-ARGUMENT...
# One folder after another: each takes all cores, and make must not read what another one is writing.
prepare() {
	local name=$1
	shift
	make -s -j"$cores" "$@" >"$logs/make-$name.log" 2>&1
	echo $? >"$logs/make-$name.code"
}

# Counts one check: count NAME LOG CODE; when it failed the end of its log is shown.
count() {
	if [ "$3" = 0 ]; then
		passed=$((passed + 1))
	else
		failed=$((failed + 1))
		echo "FAILED: $1 (log: $2)"
		tail -n 30 "$2" | sed 's/^/    /'
		return 1
	fi
}

# One check: check NAME LOG COMMAND...; a command that exits with 77 was skipped, and its last line says why.
check() {
	local name=$1 log=$2
	shift 2
	local code
	"$@" >"$log" 2>&1
	code=$?
	if [ "$code" = 77 ]; then
		echo "skipped: $name: $(tail -n 1 "$log" | sed 's/^skip: //')"
		return 0
	fi
	count "$name" "$log" "$code"
}

# What prepare NAME made, as one check.
build() { count "build $1" "$logs/make-$1.log" "$(cat "$logs/make-$1.code")"; }

# Runs the cmocka programs of build/$1 and counts their tests.
unit_tests() {
	local program log ok bad code
	local -a programs=()
	for program in build/"$1"/tests/test_*; do
		if [ -f "$program" ] && [ -x "$program" ]; then programs+=("$program"); fi
	done
	# shellcheck disable=SC2016
	printf '%s\n' "${programs[@]}" | xargs -P "$width" -I '{}' sh -c \
		'timeout 300 "$2" >"$1-${2##*/}.log" 2>&1; echo $? >"$1-${2##*/}.code"' sh "$logs/$1" '{}'
	for program in "${programs[@]}"; do
		log=$logs/$1-$(basename "$program").log
		code=$(cat "${log%.log}.code" 2>/dev/null || echo lost)
		ok=$(grep -c '^\[       OK' "$log")
		bad=$(grep -c '^\[  FAILED  \] [a-zA-Z_0-9]*$' "$log")
		# the list at the end names each failed test once more
		bad=$(((bad + 1) / 2))
		[ "$code" = 0 ] || [ "$bad" -gt 0 ] || bad=1
		passed=$((passed + ok))
		failed=$((failed + bad))
		if [ "$bad" -gt 0 ]; then
			echo "FAILED: $program: $bad (exit code $code, log: $log)"
			grep -v '^\[ RUN\|^\[       OK' "$log" | tail -n 30 | sed 's/^/    /'
		fi
	done
}

# Runs tests/cli with the tool of build/$1 and adds its totals.
cli_tests() {
	local log=$logs/cli-$1.log line
	BRDFPACK=$PWD/build/$1/brdfpack timeout 900 tests/cli/run >"$log" 2>&1
	line=$(tail -n 1 "$log")
	if [[ $line =~ ^([0-9]+)\ passed,\ ([0-9]+)\ failed ]]; then
		passed=$((passed + BASH_REMATCH[1]))
		failed=$((failed + BASH_REMATCH[2]))
		[ "${BASH_REMATCH[2]}" = 0 ] || tail -n 60 "$log" | sed 's/^/    /'
	else
		failed=$((failed + 1))
		echo "FAILED: command-line tests ended early (log: $log)"
		tail -n 30 "$log" | sed 's/^/    /'
	fi
}

job_unit() { build test && unit_tests test; }
job_cli() { build test && cli_tests test; }
job_asan() {
	export ASAN_OPTIONS=detect_leaks=1:abort_on_error=0 UBSAN_OPTIONS=print_stacktrace=1
	build asan && unit_tests asan && cli_tests asan
}
job_clang() {
	build clang
	check "libraries by -flto" "$logs/lto.log" tests/lto.sh build/lto
}
job_install() { build test && check "installed library" "$logs/install.log" tests/install.sh build/test "${test_flags[@]}"; }
job_portable() {
	build test || return
	scripts/setup.sh endian >"$logs/setup-endian.log" 2>&1 || true
	check "the reading half alone" "$logs/portable.log" tests/portable.sh build/test
}
job_mitsuba() {
	build test || return
	scripts/setup.sh mitsuba >"$logs/setup-mitsuba.log" 2>&1 || true
	check "Mitsuba 3" "$logs/mitsuba.log" tests/mitsuba.sh build/test
}
job_debian() {
	scripts/setup.sh debian >"$logs/setup-debian.log" 2>&1 || true
	check "Debian packages" "$logs/debian.log" tests/debian.sh
}
job_package() { build test && check "the Python package" "$logs/package.log" tests/python_package.sh build/test; }
job_python() {
	build test || return
	check "python reader, vectors" "$logs/python-vectors.log" tests/python_reader.sh build/test
	check "the range encoder as it is specified" "$logs/python-coder.log" tests/python_coder.py format-spec/vectors
	check "python reader, demo set" "$logs/python-demo.log" tests/python.sh build/test
}
job_valgrind() { build test && check "valgrind" "$logs/valgrind.log" tests/valgrind.sh build/test; }
job_stress() { build test && check "stress" "$logs/stress.log" make -s "${test_build[@]}" STRESS_FLAGS="-g 2 -q -v" stress; }
job_faults() { build test && check "faults" "$logs/faults.log" make -s "${test_build[@]}" faults; }
job_house() {
	check "the plan of src" "$logs/house.log" tests/house.py
	check "the form of the sources" "$logs/form.log" tests/form.sh
}
job_pinned() { build pinned && check "pinned" "$logs/pinned.log" make -s "${test_build[@]}" pinned; }
job_bench() {
	build test || return
	build bench && check "benchmarks" "$logs/bench.log" tests/bench.sh build/test
}
job_slurm() {
	build test || return
	scripts/setup.sh slurm >"$logs/setup-slurm.log" 2>&1 || true
	check "shards on Slurm" "$logs/slurm.log" tests/slurm.sh build/test
}
job_arm64() {
	build test || return
	scripts/setup.sh arm64 >"$logs/setup-arm64.log" 2>&1 || true
	NATIVE=build/test/brdfpack check "unit tests on ARM64" "$logs/arm64.log" tests/arm64.sh build/arm64
}
job_viewer() {
	build test || return
	if [ -f "$logs/make-viewer.code" ]; then build viewer || return; fi
	check "report and viewer" "$logs/viewer.log" tests/viewer.sh build/test
}
job_fuzz() { check "fuzz" "$logs/fuzz.log" make -s "${test_build[@]}" FUZZ_SECONDS=12 fuzz; }

test_flags=(CFLAGS="-O3 -g -Werror" TEST_HOOKS=1)
test_build=(BUILD=build/test "${test_flags[@]}" FAULTS_ASAN=build/asan)
start=$SECONDS
if wanted unit cli install portable package mitsuba python valgrind stress faults pinned bench slurm arm64 viewer; then prepare test "${test_build[@]}" all tests; fi
if wanted bench; then prepare bench "${test_build[@]}" build/test/bench/brdfpack-bench; fi
if wanted viewer; then
	scripts/setup.sh viewer >"$logs/setup-viewer.log" 2>&1 || true
	if command -v emcc >/dev/null; then prepare viewer "${test_build[@]}" viewer; fi
fi
if wanted pinned; then prepare pinned "${test_build[@]}" build/test/tests/pinned; fi
if wanted stress; then prepare stress "${test_build[@]}" build/test/tests/stress; fi
# no -Werror: what the sanitizers insert makes gcc warn of things that are not there
if wanted asan; then prepare asan BUILD=build/asan TEST_HOOKS=1 CFLAGS="-O1 -g" SANITIZE=address,undefined,float-cast-overflow all tests; fi
if wanted clang; then prepare clang BUILD=build/clang CC=clang CFLAGS="-O2 -g -Werror" all tests; fi
if wanted faults; then prepare faults "${test_build[@]}" faults-build; fi
if wanted fuzz; then prepare fuzz "${test_build[@]}" fuzz-build; fi
echo "built in $((SECONDS - start)) s"

run() {
	local start=$SECONDS
	passed=0
	failed=0
	"job_$1"
	echo "$1: $passed passed, $failed failed, $((SECONDS - start)) s"
}

# Waits for one of the running jobs, prints what it said and adds its totals.
collect() {
	local pid job line
	wait -n -p pid "${!running[@]}"
	job=${running[$pid]}
	unset "running[$pid]"
	cat "$logs/job-$job.log"
	line=$(tail -n 1 "$logs/job-$job.log")
	if [[ $line =~ ^$job:\ ([0-9]+)\ passed,\ ([0-9]+)\ failed ]]; then
		passed=$((passed + BASH_REMATCH[1]))
		failed=$((failed + BASH_REMATCH[2]))
	else
		failed=$((failed + 1))
		echo "FAILED: job $job ended early"
	fi
}

# Process groups of their own: jobs do not ignore SIGINT, which tests send, and can be ended together.
set -m
declare -A running=()
trap 'for pid in "${!running[@]}"; do kill -- "-$pid"; done; exit 130' INT TERM
for job in $jobs; do
	[ ${#running[@]} -lt "$lanes" ] || collect
	run "$job" </dev/null >"$logs/job-$job.log" 2>&1 &
	running[$!]=$job
done
while [ ${#running[@]} -gt 0 ]; do collect; done
echo "$passed passed, $failed failed"
[ "$failed" = 0 ]
