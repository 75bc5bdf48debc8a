/*
 * brdfpack.h: read archives of measured materials. The only installed header.
 *
 * Words. A *lattice* is the raw table of one measured isotropic material over
 * (theta_h, theta_d, phi_d); a *record* is one fitted material's bytes in an
 * archive; a *section* is a separately checksummed part of a record; a *layer*
 * is a set of sections that lowers the error to a recorded value.
 *
 * Threads. Functions may be called from any thread. An object that is passed as
 * a pointer to const may be used by several threads at once.
 *
 * Errors. Functions that can fail return a bp_status and fill the bp_error that
 * the caller supplies (NULL is allowed). After a failure, out-parameters are
 * unchanged unless their description says otherwise. The library never prints
 * and never exits.
 */
#ifndef BRDFPACK_H
#define BRDFPACK_H

#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif
#ifdef __GNUC__
#pragma GCC visibility push(default) /* the library hides every symbol that is not declared here */
#endif

#define BP_VERSION "0.1.0"

/* Status of a call. The values are pinned: they never change their meaning. */
typedef enum bp_status {
	BP_OK = 0,
	BP_ERROR_ARGUMENT = 1,    /* the caller's mistake */
	BP_ERROR_MEMORY = 2,      /* an allocation failed */
	BP_ERROR_IO = 3,          /* the system refused to read or write */
	BP_ERROR_NOT_OURS = 4,    /* this is not a brdfpack archive (or not a MERL file) */
	BP_ERROR_UNSUPPORTED = 5, /* intact, but made for a newer reader */
	BP_ERROR_CORRUPT = 6,     /* damaged: a value that no writer writes */
	BP_ERROR_CHECKSUM = 7,    /* damaged: a CRC32 differs */
	BP_ERROR_LIMIT = 8,       /* beyond a limit that the specification sets */
	BP_ERROR_NOT_FOUND = 9,   /* no material of that name or number */
	BP_ERROR_BAD_INPUT = 10   /* a measured file that cannot be packed */
} bp_status;

#define BP_NO_OFFSET UINT64_MAX

/* What went wrong, for a person: the library fills it, the caller owns it. */
typedef struct bp_error {
	bp_status status;
	uint64_t offset;   /* byte in the file where it was seen, or BP_NO_OFFSET */
	char message[512]; /* one line, control characters as \xHH, NUL-terminated */
} bp_error;

/* A short text for a status: static, never NULL. */
const char *bp_status_text(bp_status status);

/* ---- Archives ---- */

/*
 * An open archive. It never changes after opening, except for a counter, so any number of threads may use
 * it at once; only bp_archive_close must come last. It reads with pread and maps nothing: a file that is
 * cut or overwritten while open gives errors, never a crash. Every byte is checked against its CRC32
 * before it is used.
 */
typedef struct bp_archive bp_archive;

#define BP_NAME_BYTES_MAX 255
#define BP_LAYERS_MAX 16
#define BP_SECTIONS_MAX 64

/*
 * Opens the archive at `path` (a regular file) and reads its header and the root of its index: at most
 * 64 + 4096 bytes, whatever its size. The caller closes *out.
 * Errors: BP_ERROR_IO, BP_ERROR_NOT_OURS, BP_ERROR_UNSUPPORTED, BP_ERROR_CORRUPT, BP_ERROR_CHECKSUM, BP_ERROR_MEMORY.
 */
bp_status bp_archive_open(const char *path, bp_archive **out, bp_error *error);
void bp_archive_close(bp_archive *archive); /* NULL is allowed */

/* Number of materials. */
uint64_t bp_archive_count(const bp_archive *archive);

/* Bytes read from the file so far, over all threads. */
uint64_t bp_archive_bytes_read(const bp_archive *archive);

/*
 * The name of material `index`, 0 to count - 1, in the order of the names' bytes; UTF-8, NUL-terminated.
 * Reads at most one path of index pages (4096 bytes each; two or three in practice).
 * Errors: BP_ERROR_NOT_FOUND (index too large), and those of damaged or unreadable files.
 */
bp_status bp_archive_name(const bp_archive *archive, uint64_t index, char name[BP_NAME_BYTES_MAX + 1], bp_error *error);

/* The number of the material called `name`; BP_ERROR_NOT_FOUND when there is none. Reads as bp_archive_name does. */
bp_status bp_archive_find(const bp_archive *archive, const char *name, uint64_t *index, bp_error *error);

/* One layer: what loading it costs and what error is left. */
typedef struct bp_layer {
	uint32_t bytes;          /* of the record up to and including this layer, head included */
	double log_rmse;         /* rms of log10((e + 1e-3)/(b + 1e-3)) over valid cells and channels, e decoded, b measured */
	double cube_root_rmse;   /* rms of cbrt(b cos) - cbrt(e cos), cos the smaller of the two cosines */
	double largest_relative; /* largest |e - b|/(b + 1e-2) */
} bp_layer;

/* One section of a record. */
typedef struct bp_section {
	uint32_t type, codec, version; /* as the format's specification numbers them */
	uint32_t layer;                /* the first layer that needs it */
	uint32_t flags;                /* bit 0: required, bit 1: colour only, bits 2, 3, 4: for channel R, G, B alone */
	uint32_t bytes;
	double error;                  /* its own error figure, or NaN */
} bp_section;

/*
 * Robust regression (DuMouchel and O'Brien 1989) of one channel's measured values, diffuse + specular x. Profile 1: x is the
 * decoded model, over all measured cells, and decoding uses both numbers. Profile 2: x is the measured mean of the three
 * channels, over some 65,000 cells: a summary, which decoding does not use.
 */
typedef struct bp_channel {
	double diffuse;      /* 1/sr */
	double specular;     /* a ratio: x is in 1/sr */
	double rejected;     /* share of the valid cells that the regression gave no weight */
	uint32_t iterations;
	uint32_t converged;  /* 1 or 0 */
} bp_channel;

/* All that a record's head says. The caller sets struct_bytes; later versions may append members. */
typedef struct bp_material_info {
	size_t struct_bytes;       /* sizeof(bp_material_info), set by the caller */
	char name[BP_NAME_BYTES_MAX + 1];
	uint32_t profile;          /* 1: paper, 2: spectral */
	uint32_t codec_version;    /* of the encoder; 0: layers have been dropped since */
	uint32_t theta_h, theta_d, phi_d; /* cells of the lattice */
	uint32_t head_bytes, record_bytes;
	uint64_t record_offset;    /* in the file */
	bp_channel channels[3];    /* R, G, B */
	uint32_t layer_count;
	bp_layer layers[BP_LAYERS_MAX];
	uint32_t section_count;
	bp_section sections[BP_SECTIONS_MAX];
	uint32_t left_out;         /* pairs that are independent and not stored: bit 0 c_hd, bit 1 c_hphi, bit 2 all c_dphi|h */
	uint32_t effort;           /* options it was made with */
	uint32_t budget_bytes;
	double max_error;          /* 0: a budget was asked for */
	uint64_t source_bytes;     /* of the measured file */
	uint8_t source_sha256[32];
	uint64_t source_nonfinite; /* its cells that were NaN or infinite */
	double horizon_limit;      /* the lowest cosine at which anything was measured, -1 to 0 */
} bp_material_info;

/*
 * What is known of material `index` without loading it; reads its head (about 500 bytes) beside the index.
 * Errors: BP_ERROR_ARGUMENT (struct_bytes is not that of a version of this header), BP_ERROR_NOT_FOUND, and
 * those of damaged or unreadable files.
 */
bp_status bp_archive_info(const bp_archive *archive, uint64_t index, bp_material_info *info, bp_error *error);

/* One thing that is wrong with an archive. */
typedef struct bp_problem {
	const char *material; /* its name, or NULL where the header or the index is meant; valid during the call */
	bp_error error;       /* offset: in the file */
} bp_problem;

/* Is shown every problem; a result other than 0 ends the verification. */
typedef int bp_problem_fn(void *user, const bp_problem *problem);

#define BP_VERIFY_DEEP 1u /* also decode every layer of every material and check its values */

/*
 * Reads the whole file and checks all checksums, the index, the order of the names, and that there is no
 * gap, overlap or trailing byte. Goes on after damage as far as the index reaches, and reports each problem.
 * BP_OK when there is none; otherwise the status of the first, which is also in *error. BP_ERROR_ARGUMENT for unknown flags.
 */
bp_status bp_archive_verify(const bp_archive *archive, unsigned flags, bp_problem_fn *report, void *user, bp_error *error);

/* ---- Materials ---- */

/*
 * A loaded material: immutable, and independent of the archive, which may be closed. Any number of threads
 * may use it at once.
 *
 * Directions are unit vectors in the local frame of the surface, z along the normal, pointing away from the
 * surface: wi towards the light, wo towards the eye. Other lengths are normalised first (those from about
 * 1e-18 to 1e18). A direction that is below or on the horizon (z <= 0), zero, infinite or NaN is *unusable*:
 * functions say what it gives, never a NaN.
 *
 * Evaluation looks values up in one table: what a record leaves out, independent pairs and detail that is 0, costs nothing.
 *
 * Values are the BRDF f in 1/sr, linear, in the measured R, G and B; the caller multiplies by cos theta_i.
 * They are finite, not negative, and the same when wi and wo change places.
 *
 * Convention of the table. Cell (i, j, k) starts at theta_h = (i/H)^2 pi/2, theta_d = (j/D) pi/2,
 * phi_d = (k/P) pi (Rusinkiewicz 1998), and a stored value stands for its CENTRE, which is at the same for
 * i + 1/2, j + 1/2, k + 1/2. The MERL database itself says so: both cosines above -0.061 at the centre is the
 * pattern of its measured cells, but for 2 of 1,458,000, and the pattern is symmetric under k -> P - 1 - k.
 * Interpolation is trilinear between centres in i, j and k, periodic in phi_d (period pi: reciprocity); before
 * the first and beyond the last centre of theta_h and theta_d the value stays. Cells that nothing was measured
 * in hold the model's smooth continuation, so near the horizon no "not measured" mark enters. Where wi = wo,
 * phi_d is 0; where theta_h is 0, phi_h is.
 */
typedef struct bp_material bp_material;

/* How a material lies in memory; bytes for a MERL lattice, in RGB / as mean. */
typedef enum bp_form {
	BP_FORM_EXPANDED = 0, /* 16 bits per value, relative error at most 2^-11 of the decoded value; 8.8 MB / 2.9 MB */
	BP_FORM_COMPACT = 1,  /* 8 bits per value, shared scales and colours: some 0.001 in log RMSE more, 0.01 where channels end at 0; 2.6 MB / 2.0 MB */
	BP_FORM_PREVIEW = 2   /* expanded, but only every second value along each axis, each where it stands, and quicker to load: for a
	                         look, with the first layer; 1.1 MB, in a page of 2 MB where the system gives one, / 0.4 MB. Where an
	                         extent of the lattice is odd, all values are loaded */
} bp_form;

typedef enum bp_colour {
	BP_COLOUR_RGB = 0,
	BP_COLOUR_MEAN = 1, /* achromatic: the mean of the channels, given back in all three; sections for colour are not read */
	BP_COLOUR_R = 2,    /* one channel, given back in all three. Of profile 1 only its sections are read, about a third; records of */
	BP_COLOUR_G = 3,    /* other profiles do not keep channels apart: BP_ERROR_UNSUPPORTED */
	BP_COLOUR_B = 4
} bp_colour;

/* What to load. Zeroed but for struct_bytes it asks for the whole record, in RGB, expanded, without sampling. */
typedef struct bp_load_options {
	size_t struct_bytes;  /* sizeof(bp_load_options) */
	double max_log_rmse;  /* > 0: the fewest layers whose log_rmse is at most this, all when none is; 0: all */
	bp_form form;
	bp_colour colour;
	int sampling;         /* 1: also build the tables of bp_material_sample, _pdf and _albedo (0.2 MB); else 0 */
} bp_load_options;

/* What was loaded. */
typedef struct bp_loaded {
	size_t struct_bytes; /* sizeof(bp_loaded), set by the caller */
	uint32_t layers;     /* of the record's layers */
	double log_rmse;     /* their recorded error */
	uint32_t read_bytes; /* of the record: its head and the sections needed */
	size_t memory_bytes; /* all that the material occupies */
	bp_form form;
	bp_colour colour;
	int sampling;
} bp_loaded;

/*
 * Loads material `index` of the archive; options NULL: as if zeroed. The caller frees *out. Several threads
 * may load from one archive at once. Beside the result it needs 2 to 17 bytes per cell while it works, at most 25 MB for a
 * MERL lattice; more only for records of megabytes.
 * Errors: BP_ERROR_ARGUMENT (struct_bytes, an unknown form or colour, sampling neither 0 nor 1, max_log_rmse negative
 * or NaN), BP_ERROR_NOT_FOUND, BP_ERROR_MEMORY, and those of damaged or unreadable files.
 */
bp_status bp_material_load(const bp_archive *archive, uint64_t index, const bp_load_options *options, bp_material **out,
                           bp_error *error);
void bp_material_free(bp_material *material); /* NULL is allowed */

/* Fills *loaded; BP_ERROR_ARGUMENT when struct_bytes is not that of a version of this header. */
bp_status bp_material_loaded(const bp_material *material, bp_loaded *loaded, bp_error *error);

/* f(wi, wo), interpolated. An unusable direction gives 0. */
void bp_material_evaluate(const bp_material *material, const float wi[3], const float wo[3], float rgb[3]);

/* f of the cell into which the directions fall, as the MERL database's own look-up gives it; of a preview, of the first of two cells along each axis. */
void bp_material_nearest(const bp_material *material, const float wi[3], const float wo[3], float rgb[3]);

/*
 * bp_material_evaluate for `count` pairs in separate arrays of components: wi[0] holds the x of every wi, and so on.
 * The same values to the bit, several times faster from some dozens on. Outputs must not overlap anything else.
 */
void bp_material_evaluate_batch(const bp_material *material, size_t count, const float *const wi[3], const float *const wo[3],
                                float *const rgb[3]);

/*
 * Draws wi for wo, nearly in proportion to f cos theta_i, from three independent uniform numbers in [0, 1).
 * Returns its density per solid angle, exactly what bp_material_pdf returns for the pair; wi has unit length and
 * z > 0, and the weight f cos theta_i / pdf is finite. Numbers outside [0, 1) are clamped, NaN counts as 0.
 * An unusable wo, or a material that was loaded without sampling, gives density 0 and wi = 0.
 */
float bp_material_sample(const bp_material *material, const float wo[3], const float u[3], float wi[3]);

/*
 * The density of bp_material_sample. Over the hemisphere of wi it integrates to 1 and is above 0 everywhere. An unusable
 * direction, or a material that was loaded without sampling, gives 0.
 */
float bp_material_pdf(const bp_material *material, const float wi[3], const float wo[3]);

/*
 * The directional albedo: the integral of f cos theta_i over wi, for theta_o in radians in [0, pi/2). Other angles, NaN, and
 * a material that was loaded without sampling give 0. Measurements can exceed 1. Some milliseconds (a quadrature)
 * when an angle is asked for first, some ten nanoseconds when it or those around it were; the value is the same.
 */
void bp_material_albedo(const bp_material *material, float theta_o, float rgb[3]);

#ifdef __GNUC__
#pragma GCC visibility pop
#endif
#ifdef __cplusplus
}
#endif

#endif
