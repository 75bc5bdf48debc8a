/* output_file_sweep.c: what killed writers left behind, in folders where a file must have a name while it is written. */
#include "output_file.h"

#include <dirent.h>
#include <fcntl.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "output_path.h"

/* Is it one that this program made, and does nobody hold its lock? */
static bool is_stale(int fd, const void *magic, size_t magic_bytes)
{
	uint8_t head[64];
	struct stat about;
	const size_t mark_bytes = sizeof OUTPUT_UNFINISHED - 1;
	if (fstat(fd, &about) != 0 || !S_ISREG(about.st_mode) || about.st_uid != geteuid())
		return false;
	const ssize_t got = pread(fd, head, sizeof head, 0);
	if (got < (ssize_t)sizeof head || (memcmp(head, OUTPUT_UNFINISHED, mark_bytes) != 0 && memcmp(head, magic, magic_bytes) != 0))
		return false;
	return output_path_lock(fd) == 0;
}

void output_file_sweep(const char *path, const void *magic, size_t magic_bytes)
{
	struct stat about;
	bool found;
	char stem[OUTPUT_STEM_BYTES], *target = NULL;
	if (output_path_resolve(path, &target, &found, &about, NULL))
		return;
	char *folder_path = output_path_folder(target);
	DIR *folder = folder_path ? opendir(folder_path) : NULL;
	struct dirent *entry;
	output_path_stem(target, stem);
	while (folder && (entry = readdir(folder))) {
		long process;
		unsigned number;
		int end = 0;
		if (strncmp(entry->d_name, stem, strlen(stem)) != 0 ||
		    sscanf(entry->d_name + strlen(stem), "%ld-%u%n", &process, &number, &end) != 2 ||
		    entry->d_name[strlen(stem) + (size_t)end] || process == (long)getpid())
			continue;
		char *file = output_path_beside(target, entry->d_name);
		const int fd = file ? open(file, O_RDWR | O_CLOEXEC | O_NOFOLLOW | O_NONBLOCK) : -1;
		if (fd >= 0 && is_stale(fd, magic, magic_bytes))
			unlink(file);
		if (fd >= 0)
			close(fd);
		free(file);
	}
	if (folder)
		closedir(folder);
	free(folder_path);
	free(target);
}
