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
REQUIRED := -std=c17 -D_GNU_SOURCE -D_FILE_OFFSET_BITS=64 -ffp-contract=off -fno-math-errno -fno-trapping-math -fvisibility=hidden -ffunction-sections -fdata-sections -Isrc -MMD -MP
WARNINGS := -Wall -Wextra -Wshadow -Wconversion -Wstrict-prototypes -Wmissing-prototypes
ifneq ($(SANITIZE),)
SANFLAGS := -fsanitize=$(SANITIZE) -fno-sanitize-recover=all -fno-omit-frame-pointer
endif
# switches by which tests let workers crash or dawdle: in no build that is installed
TEST_HOOKS ?=
ALL_CFLAGS = $(REQUIRED) $(WARNINGS) $(CFLAGS) $(SANFLAGS) $(if $(TEST_HOOKS),-DBRDFPACK_TEST_HOOKS)
Q := $(if $(filter 1,$(V)),,@)
# quiet under make -s, and where V=1 shows the commands themselves
SAY = @$(if $(filter 1,$(V))$(findstring s,$(firstword -$(MAKEFLAGS))),true,echo) "  $(1)"

VERSION  := $(shell sed -n 's/^\#define BP_VERSION "\(.*\)"/\1/p' src/brdfpack.h)
SONAME   := libbrdfpack.so.$(firstword $(subst ., ,$(VERSION)))
SHARED   := libbrdfpack.so.$(VERSION)

# The library: everything a renderer links. The tool adds sources (libarchive), images and the command line.
TOOL_ONLY    := $(addprefix src/merl/,source.c source_kind.c source_names.c source_read.c container.c container_fault.c licence.c sha256.c \
	demo.c demo_speckle.c \
	normal_form.c spelling.c) src/memory_stream.c
LIBRARY_C    := $(filter-out $(TOOL_ONLY),$(wildcard src/*.c src/rgl/*.c src/merl/*.c src/model/*.c src/model/*/*.c src/codec/*.c src/codec/*/*.c src/archive/*.c))
TOOL_C       := $(wildcard $(TOOL_ONLY)) $(wildcard src/render/*.c) $(wildcard src/tool/*.c src/tool/*/*.c)
# Measured files of every format, read and written: for who packs.
MEASURED_C   := $(wildcard src/rgl/*.c) $(addprefix src/merl/,merl_file.c carried.c foreign.c holes.c input.c origin.c rgl_file.c rgl_lattice.c two_halves.c)
# The half that only reads: what is left of these sources when the linker drops what no function of it calls.
WRITER_C     := $(addprefix src/,descriptor.c output_file.c output_file_sweep.c output_path.c) $(MEASURED_C) \
	$(addprefix src/codec/record_,carried.c copy.c encode.c head_write.c) \
	$(addprefix src/archive/,gather.c index_write.c merge.c pack.c recover.c writer.c)
READER_C     := $(filter-out $(WRITER_C) $(wildcard src/model/fidelity*.c),$(LIBRARY_C))
READER_CALLS := $(addprefix bp_,version version_text status_text free table_bytes $(addprefix archive_,open open_memory open_source close \
	count bytes_read name find info layers sections record table verify) $(addprefix material_,load free loaded evaluate nearest \
	evaluate_batch sample pdf albedo sample_batch pdf_batch albedo_table))
READER_O     := $(READER_C:%.c=$(BUILD)/%.o)
LIBRARY_O    := $(LIBRARY_C:%.c=$(BUILD)/%.o)
TOOL_O       := $(TOOL_C:%.c=$(BUILD)/%.o)

LIBRARY_LIBS := -lz -lm
TOOL_LIBS    := -larchive -lnettle -lpng

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
	@echo "  fuzz         coverage-guided fuzzing by clang, FUZZ_SECONDS=$(FUZZ_SECONDS) for each target; what is found is kept in FUZZ_CORPUS"
	@echo "  install      into DESTDIR/PREFIX: tool, libraries, header, files for pkg-config and CMake, man pages, completions"
	@echo "  uninstall    removes what install wrote"
	@echo "  reader-sources  lists the sources of the half that only reads (compile with -Isrc, and -DBP_PORTABLE where there is no POSIX)"
	@echo "  clean        removes $(BUILD)/"
	@echo "Knobs:"
	@echo "  CC=$(CC)  CFLAGS='$(CFLAGS)'  LDFLAGS='$(LDFLAGS)'"
	@echo "  BUILD=$(BUILD)  where objects and programs go"
	@echo "  SANITIZE=address,undefined  builds with sanitizers (give it a BUILD of its own)"
	@echo "  TEST_HOOKS=1  with the switches that some command-line tests need, which are left out without"
	@echo "  PREFIX=$(PREFIX)  LIBDIR=$(LIBDIR)  DESTDIR=$(DESTDIR)"
	@echo "  V=1  shows the commands"
	@echo "scripts/setup.sh installs the Debian packages, scripts/test.sh runs every test job."

# Rebuild when the compiler or its flags change: the file changes only when they do.
FLAGS := $(CC) $(ALL_CFLAGS) $(LDFLAGS)
$(BUILD)/flags: FORCE
	@mkdir -p $(@D)
	@echo '$(FLAGS)' | cmp -s - $@ || echo '$(FLAGS)' > $@

# Files named *_avx2.c and *_avx512.c are compiled for these and called only where the processor has them; elsewhere they never are.
ifneq ($(filter x86_64-% i386-% i486-% i586-% i686-%,$(shell $(CC) -dumpmachine)),)
$(BUILD)/%_avx2.o: ALL_CFLAGS += -mavx2
$(BUILD)/%_avx512.o: ALL_CFLAGS += -mavx512f -mavx512bw -mavx512dq -mavx512vl -mprefer-vector-width=512
endif
# Link-time optimisation is for programs: the archive's internal names are made local in machine code, which -flto objects are not.
ifneq ($(filter -flto%,$(CFLAGS)),)
$(LIBRARY_O): ALL_CFLAGS += -fno-lto
endif
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

$(BUILD)/brdfpack.pc: src/brdfpack.pc.in src/brdfpack.h FORCE
	@sed -e 's|@PREFIX@|$(PREFIX)|; s|@LIBDIR@|$(LIBDIR)|; s|@VERSION@|$(VERSION)|' $< > $@

# where the package configuration finds PREFIX, from LIBDIR
TO_PREFIX = $(shell realpath -ms --relative-to="$(LIBDIR)" "$(PREFIX)")
$(BUILD)/%.cmake: src/%.cmake.in src/brdfpack.h FORCE
	@sed -e 's|@TO_PREFIX@|$(TO_PREFIX)|; s|@VERSION@|$(VERSION)|g; s|@SHARED@|$(SHARED)|; s|@SONAME@|$(SONAME)|' $< > $@
CMAKE_FILES := brdfpackConfig.cmake brdfpackConfigVersion.cmake
SHARE        = $(DESTDIR)$(PREFIX)/share

install: all $(BUILD)/brdfpack.pc $(addprefix $(BUILD)/,$(CMAKE_FILES))
	install -d $(DESTDIR)$(LIBDIR)/cmake/brdfpack $(SHARE)/bash-completion/completions $(SHARE)/zsh/site-functions $(SHARE)/fish/vendor_completions.d
	install -m 644 $(addprefix $(BUILD)/,$(CMAKE_FILES)) $(DESTDIR)$(LIBDIR)/cmake/brdfpack/
	install -m 644 scripts/completions/brdfpack.bash $(SHARE)/bash-completion/completions/brdfpack
	install -m 644 scripts/completions/_brdfpack $(SHARE)/zsh/site-functions/
	install -m 644 scripts/completions/brdfpack.fish $(SHARE)/fish/vendor_completions.d/
	install -d $(DESTDIR)$(PREFIX)/bin $(DESTDIR)$(PREFIX)/include $(DESTDIR)$(LIBDIR)/pkgconfig $(SHARE)/man/man1 $(SHARE)/man/man3
	install -m 755 $(BUILD)/brdfpack $(DESTDIR)$(PREFIX)/bin/
	install -m 644 src/brdfpack.h $(DESTDIR)$(PREFIX)/include/
	install -m 644 $(BUILD)/libbrdfpack.a $(BUILD)/libbrdfpack_reader.a $(DESTDIR)$(LIBDIR)/
	install -m 755 $(BUILD)/$(SHARED) $(DESTDIR)$(LIBDIR)/
	ln -sf $(SHARED) $(DESTDIR)$(LIBDIR)/$(SONAME)
	ln -sf $(SONAME) $(DESTDIR)$(LIBDIR)/libbrdfpack.so
	install -m 644 $(BUILD)/brdfpack.pc $(DESTDIR)$(LIBDIR)/pkgconfig/
	[ ! -f $(BUILD)/viewer/viewer.html ] || { install -d $(SHARE)/brdfpack && install -m 644 $(BUILD)/viewer/viewer.html $(BUILD)/viewer/index.html $(SHARE)/brdfpack/; }
	install -m 644 src/tool/brdfpack.1 $(SHARE)/man/man1/
	install -m 644 src/libbrdfpack.3 $(SHARE)/man/man3/
	$(if $(DESTDIR),,[ "$$(id -u)" != 0 ] || ! command -v ldconfig >/dev/null || ldconfig || :)

uninstall:
	rm -f $(SHARE)/brdfpack/viewer.html $(SHARE)/brdfpack/index.html
	rm -f $(addprefix $(DESTDIR)$(LIBDIR)/cmake/brdfpack/,$(CMAKE_FILES)) $(SHARE)/bash-completion/completions/brdfpack
	rm -f $(SHARE)/zsh/site-functions/_brdfpack $(SHARE)/fish/vendor_completions.d/brdfpack.fish
	rm -f $(DESTDIR)$(PREFIX)/bin/brdfpack $(DESTDIR)$(PREFIX)/include/brdfpack.h $(DESTDIR)$(LIBDIR)/libbrdfpack.a $(DESTDIR)$(LIBDIR)/libbrdfpack_reader.a
	rm -f $(DESTDIR)$(LIBDIR)/$(SHARED) $(DESTDIR)$(LIBDIR)/$(SONAME) $(DESTDIR)$(LIBDIR)/libbrdfpack.so
	rm -f $(DESTDIR)$(LIBDIR)/pkgconfig/brdfpack.pc $(SHARE)/man/man1/brdfpack.1 $(SHARE)/man/man3/libbrdfpack.3

include src/viewer/viewer.mk

clean:
	rm -rf $(BUILD)

# For who compiles the reader's sources into a program of their own.
reader-sources:
	@echo $(READER_C)

include src/bench/bench.mk tests/tests.mk

FORCE:
.PHONY: all help reader-sources install uninstall clean FORCE
-include $(shell find $(BUILD) -name '*.d' 2>/dev/null)
