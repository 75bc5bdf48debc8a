# tests.mk: unit tests, command-line tests, stress, faults, fuzzing. Included by the Makefile, which has the knobs.
TEST_C       := $(wildcard tests/test_*.c)
TESTS        := $(TEST_C:tests/%.c=$(BUILD)/tests/%)
TEST_LIBS    := -lcmocka -lgsl -lgslcblas

ifneq ($(BENCH_READY),yes)
TEST_C       := $(filter-out tests/test_bench_%,$(TEST_C))
TESTS        := $(TEST_C:tests/%.c=$(BUILD)/tests/%)
endif

# One test program per module; each links the library and the tool's objects without main.
$(BUILD)/tests/%: $(BUILD)/tests/%.o $(BUILD)/internal.a $(filter-out $(BUILD)/src/tool/main.o,$(TOOL_O))
	$(call SAY,LD    $@)
	$(Q)$(CC) $(ALL_CFLAGS) $(LDFLAGS) -o $@ $(filter %.o,$^) $(BUILD)/internal.a $(TEST_LIBS) $(TOOL_LIBS) $(LIBRARY_LIBS)

# tests' objects too: without them a second make compiled and linked every test again
.PRECIOUS: $(BUILD)/%.o
tests: $(TESTS)

check: check-unit check-symbols check-cli
check-unit: tests
	$(Q)for t in $(TESTS); do echo "== $$t"; $$t || exit 1; done
check-cli: all
	$(Q)[ ! -x tests/cli/run ] || BRDFPACK=$(abspath $(BUILD)/brdfpack) tests/cli/run
check-symbols: all
	$(Q)nm -g --defined-only $(BUILD)/libbrdfpack.a | awk 'NF == 3 && $$3 !~ /^bp_/ {print "libbrdfpack.a exports " $$3; bad = 1} END {exit bad}'
	$(Q)nm -D --defined-only $(BUILD)/$(SHARED) | awk '$$3 !~ /^bp_/ {print "$(SHARED) exports " $$3; bad = 1} END {exit bad}'

# Adversarial materials (tests/stress.c). `make stress STRESS_FLAGS="-s 5"` takes more seeds.
STRESS_FLAGS ?= -s 1
STRESS_O     := $(addprefix $(BUILD)/tests/,stress.o stress_cases.o stress_checks.o stress_reference.o stress_subject.o stress_trial.o)
$(BUILD)/tests/stress: $(STRESS_O) $(BUILD)/internal.a
	$(call SAY,LD    $@)
	$(Q)$(CC) $(ALL_CFLAGS) $(LDFLAGS) -o $@ $^ -lgsl -lgslcblas $(LIBRARY_LIBS)
stress: $(BUILD)/tests/stress
	$(Q)$< $(STRESS_FLAGS)
stress-builds: # the same decoded values from several compilers and levels?
	$(Q)tests/stress_builds.sh $(BUILD)/builds

# Faults survived: damaged archives under sanitizers, killed and starved builds, threads. FAULTS_FLAGS=--long takes longer.
FAULTS_FLAGS ?=
# where the sanitized objects go: another folder of the same flags need not be built twice
FAULTS_ASAN  ?= $(BUILD)/asan
$(BUILD)/tests/faults: $(addprefix $(BUILD)/,tests/faults.o tests/archive_walk.o src/tool/facts.o src/tool/json.o internal.a)
	$(call SAY,LD    $@)
	$(Q)$(CC) $(ALL_CFLAGS) $(LDFLAGS) -o $@ $^ -lpthread $(LIBRARY_LIBS)
$(BUILD)/tests/write_faults: $(addprefix $(BUILD)/,tests/write_faults.o internal.a)
	$(call SAY,LD    $@)
	$(Q)$(CC) $(ALL_CFLAGS) $(LDFLAGS) -o $@ $^ -lpthread -ldl $(LIBRARY_LIBS)
$(BUILD)/tests/fault_shim.so: tests/fault_shim.c
	@mkdir -p $(@D)
	$(call SAY,LD    $@)
	$(Q)$(CC) $(REQUIRED) $(WARNINGS) -O1 -fPIC -shared -o $@ $< -ldl
faults-build: all
	$(Q)$(MAKE) --no-print-directory $(BUILD)/tests/faults $(BUILD)/tests/write_faults $(BUILD)/tests/fault_shim.so
	$(Q)$(MAKE) --no-print-directory BUILD=$(FAULTS_ASAN) CFLAGS="-O1 -g" SANITIZE=address,undefined,float-cast-overflow $(addprefix $(FAULTS_ASAN)/tests/,faults write_faults)
	$(Q)$(MAKE) --no-print-directory BUILD=$(BUILD)/tsan CFLAGS="-O1 -g" SANITIZE=thread $(addprefix $(BUILD)/tsan/tests/,faults write_faults)
faults: faults-build
	$(Q)tests/faults.sh $(BUILD) $(FAULTS_ASAN) $(FAULTS_FLAGS)

# Coverage-guided fuzzing (clang): `make fuzz FUZZ_SECONDS=600` spends that much on each target, FUZZ_TARGETS=scene on this alone.
FUZZ_SECONDS ?= 60
FUZZ_BUILD   := $(BUILD)/fuzz
# what earlier runs found and later ones begin with; `make clean` takes it along unless it is elsewhere
FUZZ_CORPUS  ?= $(FUZZ_BUILD)/corpus
FUZZ_TARGETS ?= archive record merl manifest options scene container tensor
ifeq ($(SANITIZE),fuzzer-no-link,address,undefined)
$(BUILD)/tests/fuzz_%: $(BUILD)/tests/fuzz_%.o $(BUILD)/tests/archive_walk.o $(BUILD)/internal.a $(filter-out $(BUILD)/src/tool/main.o,$(TOOL_O))
	$(call SAY,LD    $@)
	$(Q)$(CC) $(ALL_CFLAGS) $(LDFLAGS) -fsanitize=fuzzer -o $@ $(filter %.o,$^) $(BUILD)/internal.a $(TOOL_LIBS) $(LIBRARY_LIBS)
endif
fuzz-build:
	$(Q)$(MAKE) --no-print-directory BUILD=$(FUZZ_BUILD) CC=clang CFLAGS="-O1 -g" SANITIZE=fuzzer-no-link,address,undefined $(FUZZ_TARGETS:%=$(FUZZ_BUILD)/tests/fuzz_%)
fuzz: fuzz-build
	$(Q)tests/fuzz.sh $(FUZZ_BUILD) $(FUZZ_SECONDS) $(FUZZ_CORPUS) $(FUZZ_TARGETS)

# Bytes, errors and decoded values of the demo materials against tests/pinned.tsv; PINNED_FLAGS=--write pins them anew.
PINNED_FLAGS ?=
pinned: $(BUILD)/tests/pinned
	$(Q)$(BUILD)/tests/pinned $(PINNED_FLAGS) tests/pinned.tsv

.PHONY: tests pinned check check-unit check-cli check-symbols stress stress-builds faults faults-build fuzz fuzz-build
