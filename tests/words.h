/* words.h: what a message must say. */
#ifndef TESTS_WORDS_H
#define TESTS_WORDS_H

#include <string.h>

#define expect_words(message, words) \
	do \
		if (!strstr(message, words)) \
			fail_msg("\"%s\" lacks \"%s\"", message, words); \
	while (0)

#endif
