#include "workers.h"

#include "interrupt.h"

bp_status workers_run(const struct workers_options *options, const char *const *names, size_t count, bp_error *error)
{
	struct workers_options pool = *options;
	struct workers *workers;
	size_t wanted = 0;
	for (size_t n = 0; n < count; n++)
		wanted += names[n] != NULL;
	if (wanted == 0)
		return BP_OK;
	if (wanted < pool.count)
		pool.count = (unsigned)wanted;
	bp_status status = interrupt_install(&pool.wake_fd, error);
	if (status == BP_OK)
		status = workers_start(&pool, &workers, error);
	if (status != BP_OK)
		return status;
	for (size_t n = 0; n < count && !interrupt_signal(); n++) {
		while (names[n] && !workers_idle(workers) && !interrupt_signal())
			workers_wait(workers, -1);
		if (names[n] && !interrupt_signal())
			workers_submit(workers, &(struct job){.number = n, .name = names[n], .slot = -1});
	}
	while (workers_busy(workers) && !interrupt_signal())
		workers_wait(workers, -1);
	workers_stop(workers);
	return BP_OK;
}
