#include "inputs.h"

#include <dirent.h>
#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

void inputs_name(const char *path, char *out, size_t capacity)
{
	const char *slash = strrchr(path, '/');

	snprintf(out, capacity, "%s", slash ? slash + 1 : path);
	char *dot = strrchr(out, '.');
	if (dot && dot != out)
		*dot = 0;
}

static bool add_path(struct inputs *inputs, const char *folder, const char *name)
{
	char path[4096];

	if (inputs->count == MATERIALS_MAX) {
		fprintf(stderr, "brdfpack-bench: more than %d materials\n", MATERIALS_MAX);
		return false;
	}
	snprintf(path, sizeof path, "%s%s%s", folder ? folder : "", folder ? "/" : "", name);
	inputs->paths[inputs->count] = strdup(path);
	return inputs->paths[inputs->count++] != NULL;
}

static bool complain(const char *path)
{
	fprintf(stderr, "brdfpack-bench: %s: %s\n", path, strerror(errno));
	return false;
}

bool inputs_add(struct inputs *inputs, const char *path)
{
	struct stat info;
	DIR *folder;
	struct dirent *entry;
	bool good = true;

	if (stat(path, &info))
		return complain(path);
	if (!S_ISDIR(info.st_mode))
		return add_path(inputs, NULL, path);
	if (!(folder = opendir(path)))
		return complain(path);
	while (good && (entry = readdir(folder))) {
		size_t length = strlen(entry->d_name);
		if (length > 7 && !strcmp(entry->d_name + length - 7, ".binary"))
			good = add_path(inputs, path, entry->d_name);
	}
	closedir(folder);
	return good;
}

static int by_name(const void *a, const void *b) { return strcmp(*(char *const *)a, *(char *const *)b); }

void inputs_sort(struct inputs *inputs) { qsort(inputs->paths, (size_t)inputs->count, sizeof *inputs->paths, by_name); }

bool inputs_keep_listed(struct inputs *inputs, const char *list)
{
	char line[512], name[256];
	bool keep[MATERIALS_MAX] = {false};
	FILE *file = fopen(list, "r");
	int kept = 0;

	if (!file)
		return complain(list);
	while (fgets(line, sizeof line, file)) {
		line[strcspn(line, "\t\r\n")] = 0;
		for (int n = 0; n < inputs->count; n++) {
			inputs_name(inputs->paths[n], name, sizeof name);
			keep[n] |= !strcmp(name, line);
		}
	}
	fclose(file);
	for (int n = 0; n < inputs->count; n++)
		if (keep[n])
			inputs->paths[kept++] = inputs->paths[n];
		else
			free(inputs->paths[n]);
	inputs->count = kept;
	return true;
}

void inputs_thin(struct inputs *inputs, int count)
{
	int kept = 0;

	if (inputs->count <= count)
		return;
	for (int n = 0; n < inputs->count; n++)
		if (kept < count && n == kept * (inputs->count - 1) / (count > 1 ? count - 1 : 1))
			inputs->paths[kept++] = inputs->paths[n];
		else
			free(inputs->paths[n]);
	inputs->count = kept;
}

void inputs_free(struct inputs *inputs)
{
	for (int n = 0; n < inputs->count; n++)
		free(inputs->paths[n]);
}
