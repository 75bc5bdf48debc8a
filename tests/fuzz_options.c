/* The option parser: the input's lines are the words of a command line. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "tool/options.h"

enum { WORDS_MAX = 32 };

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t count);
int LLVMFuzzerTestOneInput(const uint8_t *data, size_t count)
{
	static const struct command command = {"fuzz", NULL, "", "Usage: fuzz\n"};
	const char *output = NULL;
	uint32_t jobs = 1;
	int64_t budget = 1000;
	double error = 1;
	bool quiet = false;
	const struct option_rule rules[] = {
		{"output", 'o', option_text, .to = &output},         {"jobs", 'j', option_integer, &jobs, 1, 256},
		{"budget", 0, option_bytes, &budget, 1000, 4000000}, {"max-error", 0, option_number, &error, 1e-6, 10},
		{"quiet", 'q', option_flag, .to = &quiet},           {0}};
	char *text = malloc(count + 1), *words[WORDS_MAX + 2] = {strdup("fuzz")};
	int word_count = 1;

	memcpy(text, data, count);
	text[count] = 0;
	for (char *rest = text, *word; word_count <= WORDS_MAX && (word = strsep(&rest, "\n"));)
		words[word_count++] = word;
	char *const own = words[0]; /* getopt moves the others */
	optind = 0;
	const int code = options_read(&command, word_count, words, rules);
	if (code == OPTIONS_END ? optind < 1 || optind > word_count : code != EXIT_OK && code != EXIT_USAGE)
		abort();
	if (jobs < 1 || jobs > 256 || budget < 1000 || budget > 4000000 || !(error >= 1e-6 && error <= 10))
		abort();
	free(own);
	free(text);
	return 0;
}
