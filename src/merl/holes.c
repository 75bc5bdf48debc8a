#include "holes.h"

#include <stdlib.h>
#include <string.h>

#include "error.h"

/* Cells at the edge of the database's pattern may be black: a limit so little above its own is its own. */
static const double DARK_MARGIN = 0.01;

static const double BLACK[3] = {0};

static bool cell_holds(const struct lattice *lattice, size_t n, const double value[3])
{
	return lattice->rgb[0][n] == value[0] && lattice->rgb[1][n] == value[1] && lattice->rgb[2][n] == value[2];
}

/* How many cells of each kind there are, and how many of them hold the value. */
struct tally {
	size_t seen, seen_same;
	size_t deep;                  /* wholly below the horizon, centre below the limit: all of them hold it */
	size_t shallow, shallow_same; /* wholly below the horizon, the others */
	size_t cut_other;             /* partly above the horizon, centre below the limit, and holding something else */
};

/* The table as the search for a pattern sees it: bits of CELL_* for each cell. */
enum {
	CELL_OTHER = 1,
	CELL_SEEN = 2,
	CELL_UNDER = 4
}; /* holds something else; lies partly above; its centre is below the limit */

static void bit_set(uint8_t *marks, const uint8_t *where, size_t cells, int bit)
{
	for (size_t n = 0; n < cells; n++)
		marks[n] = (uint8_t)(marks[n] | (where[n] ? bit : 0));
}

static struct tally tally_take(const struct lattice *lattice, const uint8_t *marks)
{
	struct tally tally = {0};
	for (size_t n = 0; n < lattice_cells(lattice->dims); n++) {
		const bool seen = marks[n] & CELL_SEEN, under = marks[n] & CELL_UNDER, other = marks[n] & CELL_OTHER;
		const bool same = lattice->valid[n] && !other;
		tally.seen += seen;
		tally.seen_same += seen && same;
		tally.deep += !seen && under;
		tally.shallow += !seen && !under;
		tally.shallow_same += !seen && !under && same;
		tally.cut_other += seen && under && other;
	}
	return tally;
}

/*
 * The pattern of holes.h: its value, and marks[cells], 1 for cells that are holes where they hold it; all 0: nothing found.
 * where[cells]: room.
 */
static void pattern_find(const struct lattice *lattice, uint8_t *marks, uint8_t *where, double value[3])
{
	const struct lattice_dims dims = lattice->dims;
	const size_t cells = lattice_cells(dims), deepest = lattice_index(dims, dims.theta_h - 1, dims.theta_d - 1, 0);
	size_t others = 0;

	memset(marks, 0, cells);
	if (!lattice->valid[deepest])
		return;
	for (int c = 0; c < 3; c++)
		value[c] = lattice->rgb[c][deepest];
	for (size_t n = 0; n < cells; n++) {
		marks[n] = lattice->valid[n] && !cell_holds(lattice, n, value) ? CELL_OTHER : 0;
		others += marks[n];
	}
	double limit = lattice_lowest_below(dims, marks);
	if (limit > LATTICE_MERL_HORIZON && limit < LATTICE_MERL_HORIZON + DARK_MARGIN)
		limit = LATTICE_MERL_HORIZON;
	lattice_seen(dims, where);
	bit_set(marks, where, cells, CELL_SEEN);
	lattice_centre_below(dims, limit, where);
	bit_set(marks, where, cells, CELL_UNDER);
	const struct tally tally = tally_take(lattice, marks);
	const bool is_edge = tally.deep > 0 && tally.deep >= tally.shallow;
	const bool is_sharp = limit >= LATTICE_DEEPEST_HORIZON || 2 * tally.shallow_same <= tally.shallow;
	const bool is_rare = memcmp(value, BLACK, sizeof BLACK) == 0 || 2 * tally.seen_same <= tally.seen;
	const bool found = others && is_edge && is_sharp && is_rare;
	for (size_t n = 0; n < cells; n++)
		marks[n] = found && (marks[n] & CELL_UNDER) && (!(marks[n] & CELL_SEEN) || !tally.cut_other);
}

/* Makes holes of cells that hold the value; where[n]: candidates, NULL: all. */
static void cells_take(struct lattice *lattice, const double value[3], const uint8_t *where, struct holes *holes)
{
	const size_t cells = lattice_cells(lattice->dims);
	for (size_t n = 0; n < cells; n++)
		if (lattice->valid[n] && (!where || where[n]) && cell_holds(lattice, n, value)) {
			lattice->valid[n] = 0;
			for (int c = 0; c < 3; c++)
				lattice->rgb[c][n] = 0;
			holes->count++;
		}
}

/* How many of the seen cells hold 0 in all channels and are measured. */
static size_t black_count(const struct lattice *lattice, uint8_t *seen)
{
	size_t count = 0;
	lattice_seen(lattice->dims, seen);
	for (size_t n = 0; n < lattice_cells(lattice->dims); n++)
		count += lattice->valid[n] && seen[n] && cell_holds(lattice, n, BLACK);
	return count;
}

bp_status lattice_take_holes(struct lattice *lattice, enum zeros_rule rule, struct holes *out, bp_error *error)
{
	const size_t cells = lattice_cells(lattice->dims);
	/* a negative value says that the table marks its holes */
	const bool marked = lattice->valid_count + lattice->nonfinite_count < cells;
	struct holes holes = {0};

	*out = holes;
	if (rule == ZEROS_MEASURED || (rule == ZEROS_AUTO && marked))
		return BP_OK;
	uint8_t *room = malloc(2 * cells);
	if (!room)
		return error_memory(error, 2 * cells);
	if (!marked) {
		pattern_find(lattice, room, room + cells, holes.value);
		cells_take(lattice, holes.value, room, &holes);
	}
	if (!holes.count)
		memset(holes.value, 0, sizeof holes.value);
	if (rule == ZEROS_HOLES)
		cells_take(lattice, BLACK, NULL, &holes);
	lattice->valid_count -= holes.count;
	holes.black_count = holes.count ? black_count(lattice, room) : 0;
	free(room);
	if (!lattice->valid_count)
		return error_set(
			error, BP_ERROR_BAD_INPUT, BP_NO_OFFSET,
			"no valid cell: all that are not negative, NaN or infinite are 0 in all channels, and zeros count as holes");
	*out = holes;
	return BP_OK;
}
