/*
 * facts.h: what a record's head says, as JSON members: the same in build, list and extract.
 */
#ifndef TOOL_FACTS_H
#define TOOL_FACTS_H

#include "codec/record.h"
#include "json.h"

const char *profile_name(enum profile profile); /* as --profile takes it; "unknown" for others */
bool profile_parse(const char *text, enum profile *out);

extern const char *const ZEROS_NAMES[3]; /* of zeros_rule, as --zeros takes them */
bool zeros_parse(const char *text, enum zeros_rule *out);

extern const char *const CHANNEL_NAMES[3]; /* "red", "green", "blue" */
extern const char *const PAIR_NAMES[3];    /* bits 0 to 2 of record_head.left_out */

/* The fidelity of the last layer, which is the material's. */
const struct fidelity *head_fidelity(const struct record_head *head);

/* Members "errors", "parameters", "left_out" of the object that is open. */
void facts_brief(struct json *json, const struct record_head *head);

/* What kind of file a source was, for people: "RGL tensor file, red, green and blue". NULL for a MERL table. */
const char *origin_text(enum origin_kind kind);

/* Everything, as an object of its own: also name, source, lattice, options, layers and sections. */
void facts_print(FILE *out, bool indent, const struct record_head *head, const struct origin *origin);

#endif
