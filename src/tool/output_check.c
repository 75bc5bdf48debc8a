#include "output_check.h"

#include <fcntl.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "archive/format.h"
#include "error.h"
#include "output_file.h"
#include "render/picture.h"
#include "report.h"

enum { HEAD_BYTES = 256 };

bp_status output_check_input(const char *path, const char *input, bp_error *error)
{
	struct stat output, source;
	if (stat(path, &output) != 0 || stat(input, &source) != 0 || output.st_dev != source.st_dev || output.st_ino != source.st_ino)
		return BP_OK;
	return error_argument(error, "%s: is one of the inputs%s%s%s; give another output, or --force to replace it", path,
	                      strcmp(path, input) ? " (" : "", strcmp(path, input) ? input : "", strcmp(path, input) ? ")" : "");
}

/* Whether the file that is there is of our making. */
static bool is_ours(const char *path, enum output_kind kind)
{
	uint8_t head[HEAD_BYTES];
	const int fd = open(path, O_RDONLY | O_CLOEXEC | O_NONBLOCK);
	const ssize_t got = fd < 0 ? -1 : read(fd, head, sizeof head);
	if (fd >= 0)
		close(fd);
	if (got < 0)
		return false;
	if (kind == OUTPUT_KIND_PICTURE)
		return picture_is_ours(head, (size_t)got);
	if (kind == OUTPUT_KIND_PAGE)
		return (size_t)got >= sizeof PAGE_MARK - 1 && memcmp(head, PAGE_MARK, sizeof PAGE_MARK - 1) == 0;
	return got >= ARCHIVE_MAGIC_BYTES && memcmp(head, ARCHIVE_MAGIC, ARCHIVE_MAGIC_BYTES) == 0;
}

bp_status output_check_path(const char *path, enum output_kind kind, bool force, const char *const *inputs, size_t count,
                            bp_error *error)
{
	static const char *const MADE[] = {"archive", "picture that brdfpack drew", "page that brdfpack made"};
	struct output_file file;
	struct stat about;
	for (size_t n = 0; n < count && !force; n++)
		if (inputs[n] && output_check_input(path, inputs[n], error))
			return error->status;
	/* the way it will be made: nothing tells better that it can be */
	bp_status status = output_file_open(path, OUTPUT_REPLACE, &file, error);
	if (status)
		return status;
	output_file_discard(&file);
	if (!force && stat(path, &about) == 0 && !is_ours(path, kind))
		return error_argument(error, "%s: is there already, and is no %s; give another output, or --force to replace it", path,
		                      MADE[kind]);
	return BP_OK;
}

bool output_check(const char *path, enum output_kind kind, bool force, const char *const *inputs, size_t count)
{
	bp_error error;
	if (!output_check_path(path, kind, force, inputs, count, &error))
		return true;
	report_error(path, NULL, &error);
	return false;
}

void output_taken_report(const char *path)
{
	report_text("%s: is there already, and differs from what would be written; give another folder, or --force to replace it",
	            path);
}
