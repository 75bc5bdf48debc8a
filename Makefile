# brdfpack: `make help` lists the targets and the knobs.
.DEFAULT_GOAL := all

# Knobs: make VARIABLE=value
CC       ?= cc
BUILD    ?= build
PREFIX   ?= /usr/local
LIBDIR   ?= $(PREFIX)/lib
DESTDIR  ?=
V        ?= 0
CFLAGS   ?= -O3 -g
SANITIZE ?=
OBJCOPY  ?= objcopy

# -ffp-contract=off: results do not depend on the machine having fused multiply-add
REQUIRED := -std=c17 -D_GNU_SOURCE -ffp-contract=off -fno-math-errno -fno-trapping-math -fvisibility=hidden -ffunction-sections -fdata-sections -Isrc -MMD -MP
WARNINGS := -Wall -Wextra -Wshadow -Wconversion -Wstrict-prototypes -Wmissing-prototypes
ifneq ($(SANITIZE),)
SANFLAGS := -fsanitize=$(SANITIZE) -fno-sanitize-recover=all -fno-omit-frame-pointer
endif
ALL_CFLAGS = $(REQUIRED) $(WARNINGS) $(CFLAGS) $(SANFLAGS)
Q := $(if $(filter 1,$(V)),,@)
# quiet under make -s, and where V=1 shows the commands themselves
SAY = @$(if $(filter 1,$(V))$(findstring s,$(firstword -$(MAKEFLAGS))),true,echo) "  $(1)"

VERSION  := $(shell sed -n 's/^\#define BP_VERSION "\(.*\)"/\1/p' src/brdfpack.h)
SONAME   := libbrdfpack.so.$(firstword $(subst ., ,$(VERSION)))
SHARED   := libbrdfpack.so.$(VERSION)

# The library: everything a renderer links. The tool adds sources (libarchive), images and the command line.
TOOL_ONLY    := $(addprefix src/merl/,source.c source_kind.c container.c sha256.c demo.c) src/memory_stream.c
LIBRARY_C    := $(filter-out $(TOOL_ONLY),$(wildcard src/*.c src/merl/*.c src/model/*.c src/model/*/*.c src/codec/*.c src/codec/*/*.c src/archive/*.c))
TOOL_C       := $(wildcard $(TOOL_ONLY)) $(wildcard src/render/*.c) $(wildcard src/tool/*.c src/tool/*/*.c)
# The half that only reads: what is left of these sources when the linker drops what no function of it calls.
WRITER_C     := $(addprefix src/,output_file.c merl/merl_file.c merl/carried.c merl/spelling.c) \
	$(addprefix src/codec/record_,carried.c copy.c measure.c pack.c) \
	$(addprefix src/archive/,gather.c index_write.c merge.c pack.c recover.c temporary.c writer.c)
READER_C     := $(filter-out $(WRITER_C) $(wildcard src/model/fidelity*.c),$(LIBRARY_C))
READER_CALLS := $(addprefix bp_,version version_text status_text free table_bytes $(addprefix archive_,open open_memory open_source close \
	count bytes_read name find info layers sections record table verify) $(addprefix material_,load free loaded evaluate nearest \
	evaluate_batch sample pdf albedo sample_batch pdf_batch albedo_table))
READER_O     := $(READER_C:%.c=$(BUILD)/%.o)
LIBRARY_O    := $(LIBRARY_C:%.c=$(BUILD)/%.o)
TOOL_O       := $(TOOL_C:%.c=$(BUILD)/%.o)
TEST_C       := $(wildcard tests/test_*.c)
TESTS        := $(TEST_C:tests/%.c=$(BUILD)/tests/%)

LIBRARY_LIBS := -lz -lm
TOOL_LIBS    := -larchive -lnettle -lpng
TEST_LIBS    := -lcmocka -lgsl -lgslcblas

# The benchmark alone links solvers and other people's codecs; its tests are left out where these are missing.
BENCH_C      := $(filter-out src/bench/main.c src/bench/eval_main.c src/bench/scale_main.c,$(wildcard src/bench/*.c))
BENCH_O      := $(BENCH_C:%.c=$(BUILD)/%.o)
BENCH_LIBS   := -lgsl -lgslcblas -llapacke -lzfp -lzstd -llzma
BENCH_DEBIAN := libgsl-dev liblapacke-dev libzfp-dev libzstd-dev liblzma-dev
BENCH_READY  := $(shell printf '\043include <%s>\n' gsl/gsl_multimin.h lapacke.h zfp.h zstd.h lzma.h | $(CC) -E -x c - >/dev/null 2>&1 && echo yes)
BENCH_DATA   ?=
ifneq ($(BENCH_READY),yes)
TEST_C       := $(filter-out tests/test_bench_%,$(TEST_C))
TESTS        := $(TEST_C:tests/%.c=$(BUILD)/tests/%)
endif

all: $(BUILD)/libbrdfpack.a $(BUILD)/libbrdfpack_reader.a $(BUILD)/$(SHARED) $(BUILD)/brdfpack

help:
	@echo "Targets:"
	@echo "  all          the tool and the static and shared library, in $(BUILD)/ (the default)"
	@echo "  check        unit tests and command-line tests: quick and complete"
	@echo "  tests        builds the unit tests"
	@echo "  check-cli    command-line tests only (tests/cli)"
	@echo "  check-symbols  every public symbol begins with bp_"
	@echo "  bench        the three that follow"
	@echo "  bench-build  build, extract, list and verify times beside cat"
	@echo "  bench-stages where a build's time goes: read, clean, regression, transform, code, measure; both profiles"
	@echo "  bench-methods  run time against error, every method: $(BUILD)/bench/bench-methods.tsv, .svg"
	@echo "  bench-eval   load, evaluate and sample beside the raw table"
	@echo "  bench-scale  time and memory of every command over 100 to 1,000,000 materials: $(BUILD)/bench/scale.tsv, .svg"
	@echo "  bench-quick  run time against error on three materials: $(BUILD)/bench/bench-quick.tsv, .svg"
	@echo "  stress       hundreds of adversarial materials: one table of what holds (a few minutes)"
	@echo "  stress-builds  do decoded values depend on compiler, level or AVX2?"
	@echo "  faults       damaged archives, killed and starved builds, many loads, threads (FAULTS_FLAGS=--long: more of each)"
	@echo "  pinned       bytes, errors and values of the demo materials against tests/pinned.tsv"
	@echo "  viewer       the page's viewer, in $(BUILD)/viewer: the reader as WebAssembly (needs emscripten)"
	@echo "  fuzz         coverage-guided fuzzing by clang, FUZZ_SECONDS=$(FUZZ_SECONDS) for each target"
	@echo "  install      into DESTDIR/PREFIX: tool, libraries, header, pkg-config file, man pages"
	@echo "  uninstall    removes what install wrote"
	@echo "  reader-sources  lists the sources of the half that only reads (compile with -Isrc, and -DBP_PORTABLE where there is no POSIX)"
	@echo "  clean        removes $(BUILD)/"
	@echo "Knobs:"
	@echo "  CC=$(CC)  CFLAGS='$(CFLAGS)'  LDFLAGS='$(LDFLAGS)'"
	@echo "  BUILD=$(BUILD)  where objects and programs go"
	@echo "  SANITIZE=address,undefined  builds with sanitizers (give it a BUILD of its own)"
	@echo "  PREFIX=$(PREFIX)  LIBDIR=$(LIBDIR)  DESTDIR=$(DESTDIR)"
	@echo "  V=1  shows the commands"
	@echo "scripts/setup.sh installs the Debian packages, scripts/test.sh runs every test job."

# Rebuild when the compiler or its flags change: the file changes only when they do.
FLAGS := $(CC) $(ALL_CFLAGS) $(LDFLAGS)
$(BUILD)/flags: FORCE
	@mkdir -p $(@D)
	@echo '$(FLAGS)' | cmp -s - $@ || echo '$(FLAGS)' > $@

# Files named *_avx2.c are compiled for AVX2 and called only where the processor has it.
$(BUILD)/%_avx2.o: ALL_CFLAGS += -mavx2
$(BUILD)/%.o: %.c $(BUILD)/flags
	@mkdir -p $(@D)
	$(call SAY,CC    $<)
	$(Q)$(CC) $(ALL_CFLAGS) -fPIC -c -o $@ $<

# The demo materials' table, as C initialisers.
$(BUILD)/demo_table.inc: manifests/demo.tsv src/merl/demo_table.awk
	@mkdir -p $(@D)
	$(call SAY,AWK   $@)
	$(Q)awk -f src/merl/demo_table.awk manifests/demo.tsv > $@.part && mv $@.part $@
$(BUILD)/src/merl/demo.o: $(BUILD)/demo_table.inc
$(BUILD)/src/merl/demo.o: ALL_CFLAGS += -I$(BUILD)

# How the page of `report` looks and what its script does, as C text.
$(BUILD)/page_assets.inc: src/tool/report_page/page.css src/tool/report_page/page.js src/tool/report_page/text_to_c.awk
	@mkdir -p $(@D)
	$(call SAY,AWK   $@)
	$(Q)for part in css js; do LC_ALL=C awk -v name=PAGE_$$(echo $$part | tr a-z A-Z) -f src/tool/report_page/text_to_c.awk src/tool/report_page/page.$$part || exit 1; done > $@.part && mv $@.part $@
$(BUILD)/src/tool/report_page/page_sections.o: $(BUILD)/page_assets.inc
$(BUILD)/src/tool/report_page/page_sections.o: ALL_CFLAGS += -I$(BUILD)

# With internal symbols, for the tool and the tests.
$(BUILD)/internal.a: $(LIBRARY_O)
	$(call SAY,AR    $@)
	$(Q)rm -f $@ && $(AR) rcs $@ $^

# For everyone else: one object whose internal symbols are local, so that they clash with nobody's.
$(BUILD)/libbrdfpack.a: $(LIBRARY_O)
	$(call SAY,AR    $@)
	$(Q)$(LD) -r -o $(BUILD)/libbrdfpack.o $^
	$(Q)$(OBJCOPY) --localize-hidden $(BUILD)/libbrdfpack.o
	$(Q)rm -f $@ && $(AR) rcs $@ $(BUILD)/libbrdfpack.o

# The same of the reader alone.
$(BUILD)/libbrdfpack_reader.a: $(READER_O)
	$(call SAY,AR    $@)
	$(Q)$(LD) -r --gc-sections $(addprefix -u ,$(READER_CALLS)) -o $(BUILD)/libbrdfpack_reader.o $^
	$(Q)$(OBJCOPY) --localize-hidden $(BUILD)/libbrdfpack_reader.o
	$(Q)rm -f $@ && $(AR) rcs $@ $(BUILD)/libbrdfpack_reader.o

$(BUILD)/$(SHARED): $(LIBRARY_O)
	$(call SAY,LD    $@)
	$(Q)$(CC) $(ALL_CFLAGS) $(LDFLAGS) -shared -Wl,-soname,$(SONAME) -o $@ $^ $(LIBRARY_LIBS)

$(BUILD)/brdfpack: $(TOOL_O) $(BUILD)/internal.a
	$(call SAY,LD    $@)
	$(Q)$(CC) $(ALL_CFLAGS) $(LDFLAGS) -o $@ $(TOOL_O) $(BUILD)/internal.a $(TOOL_LIBS) $(LIBRARY_LIBS)

# One test program per module; each links the library and the tool's objects without main.
$(BUILD)/tests/%: $(BUILD)/tests/%.o $(BUILD)/internal.a $(filter-out $(BUILD)/src/tool/main.o,$(TOOL_O))
	$(call SAY,LD    $@)
	$(Q)$(CC) $(ALL_CFLAGS) $(LDFLAGS) -o $@ $(filter %.o,$^) $(BUILD)/internal.a $(TEST_LIBS) $(TOOL_LIBS) $(LIBRARY_LIBS)

$(BUILD)/bench.a: $(BENCH_O)
	$(call SAY,AR    $@)
	$(Q)rm -f $@ && $(AR) rcs $@ $^

BENCH_PARTS = $(BUILD)/bench.a $(filter-out $(BUILD)/src/tool/main.o,$(TOOL_O)) $(BUILD)/internal.a
$(BUILD)/tests/test_bench_%: $(BUILD)/tests/test_bench_%.o $(BENCH_PARTS)
	$(call SAY,LD    $@)
	$(Q)$(CC) $(ALL_CFLAGS) $(LDFLAGS) -o $@ $< $(BENCH_PARTS) -lcmocka $(BENCH_LIBS) $(TOOL_LIBS) $(LIBRARY_LIBS)

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
$(BUILD)/tests/fault_shim.so: tests/fault_shim.c
	@mkdir -p $(@D)
	$(call SAY,LD    $@)
	$(Q)$(CC) $(REQUIRED) $(WARNINGS) -O1 -fPIC -shared -o $@ $< -ldl
faults-build: all
	$(Q)$(MAKE) --no-print-directory $(BUILD)/tests/faults $(BUILD)/tests/fault_shim.so
	$(Q)$(MAKE) --no-print-directory BUILD=$(FAULTS_ASAN) CFLAGS="-O1 -g" SANITIZE=address,undefined,float-cast-overflow $(FAULTS_ASAN)/tests/faults
	$(Q)$(MAKE) --no-print-directory BUILD=$(BUILD)/tsan CFLAGS="-O1 -g" SANITIZE=thread $(BUILD)/tsan/tests/faults
faults: faults-build
	$(Q)tests/faults.sh $(BUILD) $(FAULTS_ASAN) $(FAULTS_FLAGS)

# Coverage-guided fuzzing (clang): `make fuzz FUZZ_SECONDS=600` spends that much on each target.
FUZZ_SECONDS ?= 60
FUZZ_BUILD   := $(BUILD)/fuzz
FUZZ_TARGETS := archive record merl manifest options
ifeq ($(SANITIZE),fuzzer-no-link,address,undefined)
$(BUILD)/tests/fuzz_%: $(BUILD)/tests/fuzz_%.o $(BUILD)/tests/archive_walk.o $(BUILD)/internal.a $(filter-out $(BUILD)/src/tool/main.o,$(TOOL_O))
	$(call SAY,LD    $@)
	$(Q)$(CC) $(ALL_CFLAGS) $(LDFLAGS) -fsanitize=fuzzer -o $@ $(filter %.o,$^) $(BUILD)/internal.a $(TOOL_LIBS) $(LIBRARY_LIBS)
endif
fuzz-build:
	$(Q)$(MAKE) --no-print-directory BUILD=$(FUZZ_BUILD) CC=clang CFLAGS="-O1 -g" SANITIZE=fuzzer-no-link,address,undefined $(FUZZ_TARGETS:%=$(FUZZ_BUILD)/tests/fuzz_%)
fuzz: fuzz-build
	$(Q)tests/fuzz.sh $(FUZZ_BUILD) $(FUZZ_SECONDS)

# Bytes, errors and decoded values of the demo materials against tests/pinned.tsv; PINNED_FLAGS=--write pins them anew.
PINNED_FLAGS ?=
pinned: $(BUILD)/tests/pinned
	$(Q)$(BUILD)/tests/pinned $(PINNED_FLAGS) tests/pinned.tsv

# Run time against error: `make bench BENCH_DATA=FOLDER BENCH_LABEL="what it is"`; without BENCH_DATA the demo set.
BENCH_OUT    ?= $(BUILD)/bench
BENCH_LABEL  ?= $(if $(BENCH_DATA),MERL files in $(BENCH_DATA),demo set of brdfpack synth)
BENCH_FLAGS  ?=
# where scripts/demo.sh puts it too
BENCH_DEMO   := $(BUILD)/demo/materials
$(BUILD)/bench/brdfpack-bench: $(BUILD)/src/bench/main.o $(BENCH_PARTS)
	@[ "$(BENCH_READY)" = yes ] || { echo "the benchmark needs: apt-get install $(BENCH_DEBIAN)"; exit 1; }
	@mkdir -p $(@D)
	$(call SAY,LD    $@)
	$(Q)$(CC) $(ALL_CFLAGS) $(LDFLAGS) -o $@ $< $(BENCH_PARTS) $(BENCH_LIBS) $(TOOL_LIBS) $(LIBRARY_LIBS)

bench-ready:
	@[ "$(BENCH_READY)" = yes ] || { echo "the benchmark needs: apt-get install $(BENCH_DEBIAN)"; exit 1; }

BENCH_RUN = $(BUILD)/bench/brdfpack-bench $(BENCH_FLAGS) -l "$(BENCH_LABEL)" $(or $(BENCH_DATA),$(BENCH_DEMO))
bench-data: all
	$(Q)[ -n "$(BENCH_DATA)" ] || [ -d $(BENCH_DEMO) ] || { mkdir -p $(dir $(BENCH_DEMO)) && $(BUILD)/brdfpack synth $(BENCH_DEMO); }
bench-methods bench-quick: bench-ready all
	$(Q)$(MAKE) --no-print-directory $(BUILD)/bench/brdfpack-bench bench-data
	$(Q)BENCH_COMMIT="$$(git describe --always --dirty 2>/dev/null)" $(BENCH_RUN) $(if $(filter bench-quick,$@),-q -j 2) -o $(BENCH_OUT)/$@.tsv
	$(Q)scripts/bench_plot.sh $(BENCH_OUT)/$@.tsv $(BENCH_OUT)/$@

# Load, evaluate and sample beside the raw table: the same data, packed first. BENCH_EVAL_FLAGS=-s: the spread of sampling weights.
$(BUILD)/bench/brdfpack-bench-eval: $(BUILD)/src/bench/eval_main.o $(BUILD)/bench.a $(BUILD)/internal.a
	@mkdir -p $(@D)
	$(call SAY,LD    $@)
	$(Q)$(CC) $(ALL_CFLAGS) $(LDFLAGS) -o $@ $^ $(LIBRARY_LIBS)
BENCH_EVAL_FLAGS ?=
bench-eval: bench-ready bench-data $(BUILD)/bench/brdfpack-bench-eval
	$(Q)[ $(BENCH_OUT)/eval.bpk -nt $(BUILD)/brdfpack ] || { mkdir -p $(BENCH_OUT) && $(BUILD)/brdfpack build -q -o $(BENCH_OUT)/eval.bpk $(or $(BENCH_DATA),$(BUILD)/demo); }
	$(Q)BENCH_COMMIT="$$(git describe --always --dirty 2>/dev/null)" $(BUILD)/bench/brdfpack-bench-eval $(BENCH_EVAL_FLAGS) $(BENCH_OUT)/eval.bpk $(or $(BENCH_DATA),$(BUILD)/demo)

# Archives of 100 to 1,000,000 materials: does the cost of each stay flat? BENCH_SCALE_FLAGS="--most 10000" for less.
$(BUILD)/bench/brdfpack-bench-scale: $(BUILD)/src/bench/scale_main.o $(BUILD)/internal.a
	@mkdir -p $(@D)
	$(call SAY,LD    $@)
	$(Q)$(CC) $(ALL_CFLAGS) $(LDFLAGS) -o $@ $^ $(LIBRARY_LIBS)
BENCH_SCALE_FLAGS ?=
bench-scale: all $(BUILD)/bench/brdfpack-bench-scale
	$(Q)BRDFPACK=$(BUILD)/brdfpack src/bench/bench_scale.py --scale $(BUILD)/bench/brdfpack-bench-scale --out $(BENCH_OUT)/scale $(BENCH_SCALE_FLAGS) $(BENCH_OUT)

# of the two scripts: --runs N, --names FILE; of bench_build.py: --cold
BENCH_BUILD_FLAGS ?=
bench: bench-build bench-stages
	$(Q)$(MAKE) --no-print-directory bench-methods
bench-build: bench-data
	$(Q)BRDFPACK=$(BUILD)/brdfpack src/bench/bench_build.py --label "$(BENCH_LABEL)" $(BENCH_BUILD_FLAGS) $(or $(BENCH_DATA),$(BENCH_DEMO))
bench-stages: bench-data
	$(Q)BRDFPACK=$(BUILD)/brdfpack src/bench/bench_stages.py --label "$(BENCH_LABEL)" $(filter-out --cold,$(BENCH_BUILD_FLAGS)) $(or $(BENCH_DATA),$(BENCH_DEMO))

$(BUILD)/brdfpack.pc: src/brdfpack.pc.in src/brdfpack.h FORCE
	@sed -e 's|@PREFIX@|$(PREFIX)|; s|@LIBDIR@|$(LIBDIR)|; s|@VERSION@|$(VERSION)|' $< > $@

install: all $(BUILD)/brdfpack.pc
	install -d $(DESTDIR)$(PREFIX)/bin $(DESTDIR)$(PREFIX)/include $(DESTDIR)$(LIBDIR)/pkgconfig $(DESTDIR)$(PREFIX)/share/man/man1 $(DESTDIR)$(PREFIX)/share/man/man3
	install -m 755 $(BUILD)/brdfpack $(DESTDIR)$(PREFIX)/bin/
	install -m 644 src/brdfpack.h $(DESTDIR)$(PREFIX)/include/
	install -m 644 $(BUILD)/libbrdfpack.a $(BUILD)/libbrdfpack_reader.a $(DESTDIR)$(LIBDIR)/
	install -m 755 $(BUILD)/$(SHARED) $(DESTDIR)$(LIBDIR)/
	ln -sf $(SHARED) $(DESTDIR)$(LIBDIR)/$(SONAME)
	ln -sf $(SONAME) $(DESTDIR)$(LIBDIR)/libbrdfpack.so
	install -m 644 $(BUILD)/brdfpack.pc $(DESTDIR)$(LIBDIR)/pkgconfig/
	[ ! -f $(BUILD)/viewer/viewer.html ] || { install -d $(DESTDIR)$(PREFIX)/share/brdfpack && install -m 644 $(BUILD)/viewer/viewer.html $(BUILD)/viewer/index.html $(DESTDIR)$(PREFIX)/share/brdfpack/; }
	install -m 644 src/tool/brdfpack.1 $(DESTDIR)$(PREFIX)/share/man/man1/
	install -m 644 src/libbrdfpack.3 $(DESTDIR)$(PREFIX)/share/man/man3/

uninstall:
	rm -f $(DESTDIR)$(PREFIX)/bin/brdfpack $(DESTDIR)$(PREFIX)/include/brdfpack.h $(DESTDIR)$(LIBDIR)/libbrdfpack.a $(DESTDIR)$(LIBDIR)/libbrdfpack_reader.a
	rm -f $(DESTDIR)$(LIBDIR)/$(SHARED) $(DESTDIR)$(LIBDIR)/$(SONAME) $(DESTDIR)$(LIBDIR)/libbrdfpack.so
	rm -f $(DESTDIR)$(LIBDIR)/pkgconfig/brdfpack.pc $(DESTDIR)$(PREFIX)/share/man/man1/brdfpack.1 $(DESTDIR)$(PREFIX)/share/man/man3/libbrdfpack.3

include src/viewer/viewer.mk

clean:
	rm -rf $(BUILD)

# For who compiles the reader's sources into a program of their own.
reader-sources:
	@echo $(READER_C)

FORCE:
.PHONY: all help reader-sources tests pinned check check-unit check-cli check-symbols bench bench-build bench-stages bench-ready bench-data bench-methods bench-quick bench-eval bench-scale stress stress-builds faults faults-build fuzz fuzz-build install uninstall clean FORCE
-include $(shell find $(BUILD) -name '*.d' 2>/dev/null)
