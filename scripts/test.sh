#!/usr/bin/env bash
# Installs what is missing, builds, runs test jobs, prints totals.
#
#     scripts/test.sh [JOB]...
#
#     unit      unit tests, built by gcc with warnings as errors
#     cli       command-line tests (tests/cli)
#     install   installs into a scratch folder; symbols; a consumer built through pkg-config
#     python    the independent Python reader against the C library
#     asan      unit and command-line tests with AddressSanitizer and UBSan
#     clang     builds everything by clang with warnings as errors
#     valgrind  a small build, list, extract and verify under valgrind
#     stress    adversarial materials through every profile (the short form of `make stress`)
#     faults    damaged archives, killed and starved builds, threads (the short form of `make faults`)
#     bench     the benchmark programs on small tables: they run, and their tables and plots are whole
#     fuzz      each fuzz target for some seconds
#
# Without a JOB: all of them. The last line is "N passed, M failed"; the exit code is 1 when M > 0.
set -uo pipefail
cd "$(dirname "$0")/.." || exit 1

all_jobs="unit cli install python asan clang valgrind stress faults bench fuzz"
jobs=${*:-$all_jobs}
logs=build/logs
passed=0
failed=0

for job in $jobs; do
	case " $all_jobs " in
	*" $job "*) ;;
	*)
		echo "test.sh: unknown job '$job'; jobs are $all_jobs" >&2
		exit 2
		;;
	esac
done

groups="build test"
case " $jobs " in *" asan "* | *" clang "* | *" valgrind "* | *" faults "* | *" fuzz "*) groups+=" slow" ;; esac
# shellcheck disable=SC2086
scripts/setup.sh $groups || exit 1
mkdir -p "$logs"
parallel=$(nproc)

# One check: check NAME LOG COMMAND...; on failure the end of its log is shown.
check() {
	local name=$1 log=$2
	shift 2
	if "$@" >"$log" 2>&1; then
		passed=$((passed + 1))
	else
		failed=$((failed + 1))
		echo "FAILED: $name (log: $log)"
		tail -n 30 "$log" | sed 's/^/    /'
		return 1
	fi
}

# Builds into build/$1 with the make variables that follow; counts as one check.
build() {
	local folder=$1
	shift
	check "build $folder" "$logs/make-$folder.log" make -s -j"$parallel" BUILD="build/$folder" "$@" all tests
}

# Runs the cmocka programs of build/$1 and counts their tests.
unit_tests() {
	local program log ok bad code
	for program in build/"$1"/tests/test_*; do
		if [ ! -f "$program" ] || [ ! -x "$program" ]; then continue; fi
		log=$logs/$1-$(basename "$program").log
		timeout 300 "$program" >"$log" 2>&1
		code=$?
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
	BRDFPACK=$PWD/build/$1/brdfpack timeout 500 tests/cli/run >"$log" 2>&1
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

job_unit() { build test CFLAGS="-O3 -g -Werror" && unit_tests test; }
job_cli() { build test CFLAGS="-O3 -g -Werror" && cli_tests test; }
# no -Werror: what the sanitizers insert makes gcc warn of things that are not there
job_asan() {
	export ASAN_OPTIONS=detect_leaks=1:abort_on_error=0 UBSAN_OPTIONS=print_stacktrace=1
	build asan CFLAGS="-O1 -g" SANITIZE=address,undefined,float-cast-overflow && unit_tests asan && cli_tests asan
}
job_clang() { build clang CC=clang CFLAGS="-O2 -g -Werror"; }
job_install() { build test CFLAGS="-O3 -g -Werror" && check "installed library" "$logs/install.log" tests/install.sh build/test CFLAGS="-O3 -g -Werror"; }
job_python() {
	build test CFLAGS="-O3 -g -Werror" || return
	check "python reader, vectors" "$logs/python-vectors.log" tests/python_reader.sh build/test
	check "python reader, demo set" "$logs/python-demo.log" tests/python.sh build/test
}
job_valgrind() { build test CFLAGS="-O3 -g -Werror" && check "valgrind" "$logs/valgrind.log" tests/valgrind.sh build/test; }
job_stress() {
	build test CFLAGS="-O3 -g -Werror" || return
	check "stress" "$logs/stress.log" make -s BUILD=build/test CFLAGS="-O3 -g -Werror" STRESS_FLAGS="-g 2 -q -v" stress
}
job_faults() {
	build test CFLAGS="-O3 -g -Werror" || return
	check "faults" "$logs/faults.log" make -s -j"$parallel" BUILD=build/test CFLAGS="-O3 -g -Werror" FAULTS_ASAN=build/asan faults
}
job_bench() {
	build test CFLAGS="-O3 -g -Werror" || return
	check "benchmark program" "$logs/bench-make.log" make -s BUILD=build/test CFLAGS="-O3 -g -Werror" build/test/bench/brdfpack-bench &&
		check "benchmarks" "$logs/bench.log" tests/bench.sh build/test
}
job_fuzz() { check "fuzz" "$logs/fuzz.log" make -s -j"$parallel" BUILD=build/test CFLAGS="-O3 -g -Werror" FUZZ_SECONDS=12 fuzz; }

for job in $jobs; do
	before=$passed
	start=$SECONDS
	broken=$failed
	"job_$job"
	echo "$job: $((passed - before)) passed, $((failed - broken)) failed, $((SECONDS - start)) s"
done
echo "$passed passed, $failed failed"
[ "$failed" = 0 ]
