# The viewer: our own reader as WebAssembly, and the page's part that draws. Optional: needs emcc (Debian package emscripten).
EMCC         ?= emcc
VIEWER_BUILD := $(BUILD)/viewer
WASM_BUILD   := $(BUILD)/wasm
# The half that only reads, and MERL files, which can be dropped onto the page. Kernels for AVX2 are compiled as plain ones and never called.
VIEWER_C     := $(READER_C) $(MEASURED_C) src/render/lights.c $(wildcard src/viewer/*.c)
VIEWER_O     := $(VIEWER_C:%.c=$(WASM_BUILD)/%.o)
WASM_CFLAGS  := -O3 -msimd128 -std=gnu17 -D_GNU_SOURCE -DBP_PORTABLE -ffp-contract=off -fno-math-errno -fno-trapping-math -Isrc -Wall -Wextra -Wshadow -ffunction-sections -fdata-sections -fvisibility=hidden -MMD -MP
WASM_LDFLAGS := -O3 --no-entry -sSTANDALONE_WASM -sALLOW_MEMORY_GROWTH=1 -sERROR_ON_UNDEFINED_SYMBOLS=0

$(WASM_BUILD)/%.o: %.c src/viewer/viewer.mk
	@mkdir -p $(@D)
	$(call SAY,EMCC  $<)
	$(Q)$(EMCC) $(WASM_CFLAGS) -c -o $@ $<

# what the page provides stays undefined; the linker warns of each, and viewer.js of those that it does not know
$(VIEWER_BUILD)/viewer.wasm: $(VIEWER_O) src/viewer/viewer.h
	@mkdir -p $(@D)
	$(call SAY,LD    $@)
	$(Q)$(EMCC) $(WASM_LDFLAGS) -o $@ $(VIEWER_O) 2>$@.log || { cat $@.log; rm -f $@; exit 1; }

# The part of the page: style, markup, the module as text, shaders, script.
$(VIEWER_BUILD)/viewer.html: $(VIEWER_BUILD)/viewer.wasm $(addprefix src/viewer/,bundle.sh viewer.css viewer.html brdfpack.glsl sphere.glsl show.glsl module.js draw.js polar.js viewer.js)
	$(call SAY,PAGE  $@)
	$(Q)src/viewer/bundle.sh $< > $@.part && mv $@.part $@

# The page alone, for archives that are dropped onto it. An archive's page has its name: this one's says that there is none.
$(VIEWER_BUILD)/index.html: $(VIEWER_BUILD)/viewer.html $(BUILD)/brdfpack format-spec/vectors/good-empty.bpk
	$(call SAY,PAGE  $@)
	$(Q)cp format-spec/vectors/good-empty.bpk "$(VIEWER_BUILD)/no archive yet"
	$(Q)$(BUILD)/brdfpack report -q --force -o $@ "$(VIEWER_BUILD)/no archive yet"
	$(Q)rm "$(VIEWER_BUILD)/no archive yet"

viewer:
	@command -v $(EMCC) >/dev/null || { echo "the viewer needs emcc: apt-get install emscripten"; exit 1; }
	$(Q)$(MAKE) --no-print-directory $(VIEWER_BUILD)/viewer.html $(VIEWER_BUILD)/index.html
.PHONY: viewer
