/* The manifest reader on arbitrary text. */
#include <stdlib.h>
#include <string.h>

#include "tool/build/manifest.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t count);
int LLVMFuzzerTestOneInput(const uint8_t *data, size_t count)
{
	struct manifest manifest = {0};
	char *text = malloc(count + 1);
	memcpy(text, data, count);
	if (manifest_parse(text, count, &manifest, NULL) != BP_OK)
		return 0;
	for (size_t i = 0; i < manifest.count; i++)
		if (manifest_find(&manifest, manifest.entries[i].name) != &manifest.entries[i])
			abort();
	manifest_free(&manifest);
	return 0;
}
