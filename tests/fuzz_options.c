/* The option parser: the input's lines are the words of a command line. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "tool/options.h"

enum { WORDS_MAX = 32, OPTION_BUDGET = OPTION_LONG, OPTION_ERROR };

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t count);
int LLVMFuzzerTestOneInput(const uint8_t *data, size_t count)
{
	static const struct command command = {"fuzz", NULL, "", "Usage: fuzz\n"};
	static const struct option names[] = {{"output", required_argument, NULL, 'o'},
	                                      {"jobs", required_argument, NULL, 'j'},
	                                      {"budget", required_argument, NULL, OPTION_BUDGET},
	                                      {"max-error", required_argument, NULL, OPTION_ERROR},
	                                      {"quiet", no_argument, NULL, 'q'},
	                                      {0}};
	char *text = malloc(count + 1), *words[WORDS_MAX + 2] = {strdup("fuzz")};
	int word_count = 1, option;
	int64_t number;
	double real;

	memcpy(text, data, count);
	text[count] = 0;
	for (char *rest = text, *word; word_count <= WORDS_MAX && (word = strsep(&rest, "\n"));)
		words[word_count++] = word;
	char *const own = words[0]; /* getopt moves the others */
	optind = 0;
	while ((option = options_next(&command, word_count, words, "o:j:q", names)) >= 0) {
		if (option == 'j' && option_integer(&command, "-j", optarg, 1, 256, &number) && (number < 1 || number > 256))
			abort();
		if (option == OPTION_BUDGET && option_bytes(&command, "--budget", optarg, 1000, 4000000, &number) &&
		    (number < 1000 || number > 4000000))
			abort();
		if (option == OPTION_ERROR && option_number(&command, "--max-error", optarg, 1e-6, 10, &real) &&
		    !(real >= 1e-6 && real <= 10))
			abort();
	}
	if (option == OPTIONS_END && (optind < 1 || optind > word_count))
		abort();
	free(own);
	free(text);
	return 0;
}
