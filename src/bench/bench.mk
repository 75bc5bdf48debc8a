# bench.mk: benchmarks, which the product does not need. Included by the Makefile, which has the knobs.
# The benchmark alone links solvers and other people's codecs; its tests are left out where these are missing.
BENCH_C      := $(filter-out src/bench/main.c src/bench/eval_main.c src/bench/scale_main.c,$(wildcard src/bench/*.c))
BENCH_O      := $(BENCH_C:%.c=$(BUILD)/%.o)
BENCH_LIBS   := -lgsl -lgslcblas -llapacke -lzfp -lzstd -llzma
BENCH_DEBIAN := libgsl-dev liblapacke-dev libzfp-dev libzstd-dev liblzma-dev
BENCH_READY  := $(shell printf '\043include <%s>\n' gsl/gsl_multimin.h lapacke.h zfp.h zstd.h lzma.h | $(CC) -E -x c - >/dev/null 2>&1 && echo yes)
BENCH_DATA   ?=

$(BUILD)/bench.a: $(BENCH_O)
	$(call SAY,AR    $@)
	$(Q)rm -f $@ && $(AR) rcs $@ $^

BENCH_PARTS = $(BUILD)/bench.a $(filter-out $(BUILD)/src/tool/main.o,$(TOOL_O)) $(BUILD)/internal.a
$(BUILD)/tests/test_bench_%: $(BUILD)/tests/test_bench_%.o $(BENCH_PARTS)
	$(call SAY,LD    $@)
	$(Q)$(CC) $(ALL_CFLAGS) $(LDFLAGS) -o $@ $< $(BENCH_PARTS) -lcmocka $(BENCH_LIBS) $(TOOL_LIBS) $(LIBRARY_LIBS)

# Run time against error: `make bench BENCH_DATA=FOLDER BENCH_LABEL="what it is"`; without BENCH_DATA the demo set.
BENCH_OUT    ?= $(BUILD)/bench
BENCH_LABEL  ?= $(if $(BENCH_DATA),MERL files in $(BENCH_DATA),demo set of brdfpack synth)
BENCH_FLAGS  ?=
# where scripts/demo.sh puts it too
BENCH_DEMO   := $(BUILD)/demo/materials
$(BUILD)/bench/brdfpack-bench: $(BUILD)/src/bench/main.o
$(BUILD)/bench/brdfpack-bench-eval: $(BUILD)/src/bench/eval_main.o
$(BUILD)/bench/brdfpack-bench $(BUILD)/bench/brdfpack-bench-eval: $(BENCH_PARTS) | bench-ready
	@mkdir -p $(@D)
	$(call SAY,LD    $@)
	$(Q)$(CC) $(ALL_CFLAGS) $(LDFLAGS) -o $@ $(filter %main.o,$^) $(BENCH_PARTS) $(BENCH_LIBS) $(TOOL_LIBS) $(LIBRARY_LIBS)

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

.PHONY: bench bench-build bench-stages bench-ready bench-data bench-methods bench-quick bench-eval bench-scale
