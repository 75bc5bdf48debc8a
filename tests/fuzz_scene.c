/* The scene reader on arbitrary text: its words are in ascending order, none of them twice. */
#include <stdlib.h>
#include <string.h>

#include "fuzz_file.h"
#include "tool/scene.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t count);
int LLVMFuzzerTestOneInput(const uint8_t *data, size_t count)
{
	struct scene_words words = {0};
	if (scene_words_add(&words, fuzz_file(data, count), NULL) != BP_OK)
		abort();
	scene_words_sort(&words);
	for (size_t n = 0; n < words.count; n++) {
		if (words.word[n].text[0] == '\0' || (n > 0 && strcmp(words.word[n - 1].text, words.word[n].text) >= 0))
			abort();
	}
	scene_words_free(&words);
	return 0;
}
