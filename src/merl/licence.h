/* licence.h: texts that say on what terms measured files may be used. They are not packed; who packs should know of them. */
#ifndef MERL_LICENCE_H
#define MERL_LICENCE_H

#include <stddef.h>

enum { LICENCES_MAX = 16 };

/* The first ones found; start from a zeroed struct. */
struct licences {
	char *path[LICENCES_MAX]; /* "FILE", or "CONTAINER: MEMBER"; legal text */
	size_t count;
};

/* Keeps the name of such a text: LICENSE.txt, COPYING, NOTICE.md, rgl-licence.pdf ... member: inside that container, or NULL. */
void licences_note(struct licences *licences, const char *path, const char *member);
void licences_free(struct licences *licences);

#endif
