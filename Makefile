# brdfpack: `make help` lists the targets and the knobs.
.DEFAULT_GOAL := all

CC      ?= cc
BUILD   ?= build
PREFIX  ?= /usr/local
DESTDIR ?=
V       ?= 0
CFLAGS  ?= -O3 -g
# -ffp-contract=off: results do not depend on the machine having fused multiply-add
REQUIRED := -std=c17 -D_GNU_SOURCE -ffp-contract=off -fno-math-errno -fno-trapping-math -fvisibility=hidden -Isrc -MMD -MP
WARNINGS := -Wall -Wextra -Wshadow -Wconversion -Wstrict-prototypes -Wmissing-prototypes
SANITIZE ?=
ifneq ($(SANITIZE),)
SANFLAGS := -fsanitize=$(SANITIZE) -fno-sanitize-recover=all -fno-omit-frame-pointer
endif
ALL_CFLAGS = $(REQUIRED) $(WARNINGS) $(CFLAGS) $(SANFLAGS)
Q := $(if $(filter 1,$(V)),,@)

# The library: everything a renderer links. The tool adds sources/ (libarchive) and the command line.
TOOL_ONLY    := src/merl/source.c src/merl/sha256.c src/merl/demo.c
LIBRARY_C    := $(filter-out $(TOOL_ONLY),$(wildcard src/*.c src/merl/*.c src/model/*.c src/codec/*.c src/archive/*.c))
TOOL_C       := $(wildcard $(TOOL_ONLY)) $(wildcard src/render/*.c) $(wildcard src/tool/*.c)
LIBRARY_O    := $(LIBRARY_C:%.c=$(BUILD)/%.o)
TOOL_O       := $(TOOL_C:%.c=$(BUILD)/%.o)
TEST_C       := $(wildcard tests/test_*.c)
TESTS        := $(TEST_C:tests/%.c=$(BUILD)/tests/%)

LIBRARY_LIBS := -lz -lm
TOOL_LIBS    := -larchive -lnettle -lpng
TEST_LIBS    := -lcmocka -lgsl -lgslcblas

all: $(BUILD)/libbrdfpack.a $(BUILD)/brdfpack

# Files named kernels_avx2.c are compiled for AVX2 and called only where the processor has it.
$(BUILD)/%_avx2.o: ALL_CFLAGS += -mavx2
$(BUILD)/%.o: %.c
	@mkdir -p $(@D)
	@[ $(V) = 1 ] || echo "  CC    $<"
	$(Q)$(CC) $(ALL_CFLAGS) -fPIC -c -o $@ $<

$(BUILD)/libbrdfpack.a: $(LIBRARY_O)
	@[ $(V) = 1 ] || echo "  AR    $@"
	$(Q)rm -f $@ && $(AR) rcs $@ $^

$(BUILD)/brdfpack: $(TOOL_O) $(BUILD)/libbrdfpack.a
	@[ $(V) = 1 ] || echo "  LD    $@"
	$(Q)$(CC) $(ALL_CFLAGS) $(LDFLAGS) -o $@ $(TOOL_O) $(BUILD)/libbrdfpack.a $(TOOL_LIBS) $(LIBRARY_LIBS)

# One test program per module; each links the library and the tool's objects without main.
$(BUILD)/tests/%: $(BUILD)/tests/%.o $(BUILD)/libbrdfpack.a $(filter-out $(BUILD)/src/tool/main.o,$(TOOL_O))
	@[ $(V) = 1 ] || echo "  LD    $@"
	$(Q)$(CC) $(ALL_CFLAGS) $(LDFLAGS) -o $@ $(filter %.o,$^) $(BUILD)/libbrdfpack.a $(TEST_LIBS) $(TOOL_LIBS) $(LIBRARY_LIBS)

.PRECIOUS: $(BUILD)/tests/%.o
tests: $(TESTS)
check: all tests
	$(Q)for t in $(TESTS); do echo "== $$t"; $$t || exit 1; done

clean:
	rm -rf $(BUILD)

.PHONY: all tests check clean
-include $(shell find $(BUILD) -name '*.d' 2>/dev/null)
