/*
 * brdfpack.h: read and write archives of measured materials. The only installed header.
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

/*
 * What stands before every function. A program that links the DLL on Windows defines BP_SHARED; whoever compiles the library
 * into one defines BP_BUILD too. Elsewhere the library hides every symbol but these.
 */
#ifndef BP_API
#if defined _WIN32 && defined BP_SHARED
#ifdef BP_BUILD
#define BP_API __declspec(dllexport)
#else
#define BP_API __declspec(dllimport)
#endif
#elif defined __GNUC__
#define BP_API __attribute__((visibility("default")))
#else
#define BP_API
#endif
#endif

/* The version of this header: text, and numbers for the preprocessor. */
#define BP_VERSION "0.2.0"
#define BP_VERSION_MAJOR 0
#define BP_VERSION_MINOR 2
#define BP_VERSION_PATCH 0
#define BP_VERSION_NUMBER (BP_VERSION_MAJOR * 10000 + BP_VERSION_MINOR * 100 + BP_VERSION_PATCH)

/* The version of the library that runs, as BP_VERSION_NUMBER: another one than the header's where an older one is installed. */
BP_API int bp_version(void);
/* The same as text: static. */
BP_API const char *bp_version_text(void);

/* Status of a call. The values are pinned: they never change their meaning. */
typedef enum bp_status {
	BP_OK = 0,
	BP_ERROR_ARGUMENT = 1, /* the caller's mistake */
	BP_ERROR_MEMORY = 2,   /* an allocation failed */
	BP_ERROR_IO = 3,       /* the system refused to read or write */
	BP_ERROR_NOT_OURS = 4, /* this is not a brdfpack archive (or not a MERL file) */
	/* intact, but made for a newer reader, or by a writer so old that it is no longer read: the message says */
	BP_ERROR_UNSUPPORTED = 5,
	BP_ERROR_CORRUPT = 6,    /* damaged: a value that no writer writes */
	BP_ERROR_CHECKSUM = 7,   /* damaged: a CRC32 differs */
	BP_ERROR_LIMIT = 8,      /* beyond a limit that the specification sets */
	BP_ERROR_NOT_FOUND = 9,  /* no material of that name or number */
	BP_ERROR_BAD_INPUT = 10, /* a measured material that cannot be packed */
	BP_ERROR_CANCELLED = 11  /* the caller's callback ended it */
} bp_status;

#define BP_NO_OFFSET UINT64_MAX

/* What went wrong, for a person: the library fills it, the caller owns it. */
typedef struct bp_error {
	bp_status status;
	uint64_t offset;   /* byte in the file where it was seen, or BP_NO_OFFSET */
	char message[512]; /* one line, control characters as \xHH, NUL-terminated */
} bp_error;

/* A short text for a status: static, never NULL. */
BP_API const char *bp_status_text(bp_status status);

/*
 * Frees what a function says is freed with bp_free; NULL is allowed. On Windows a DLL's free may be another than the program's.
 */
BP_API void bp_free(void *block);

/* ---- Archives ---- */

/*
 * An open archive. It never changes after opening, except for a counter, so any number of threads may use
 * it at once; only bp_archive_close must come last. It reads and maps nothing: a file that is
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
BP_API bp_status bp_archive_open(const char *path, bp_archive **out, bp_error *error);
/*
 * The same for an archive of `count` bytes in memory, which must stay as they are until bp_archive_close; nothing is copied.
 * Errors: as bp_archive_open, without BP_ERROR_IO.
 */
BP_API bp_status bp_archive_open_memory(const void *bytes, size_t count, bp_archive **out, bp_error *error);

/*
 * Reads `count` bytes (at least 1) at `offset`, within the size that was told, and returns 0, or anything else where it
 * cannot: the function that wanted them then fails with BP_ERROR_IO. Called from the threads that use the archive, several at
 * once.
 */
typedef int bp_read_fn(void *user, uint64_t offset, void *bytes, size_t count);

/* Where an archive is read from. The caller sets struct_bytes. */
typedef struct bp_source {
	size_t struct_bytes; /* sizeof(bp_source) */
	bp_read_fn *read;
	void (*close)(void *user); /* NULL, or called once by bp_archive_close; not where opening fails */
	void *user;
	uint64_t bytes; /* of the archive */
} bp_source;

/*
 * The same through callbacks: an engine's own file system, a browser. *source is copied. BP_ERROR_ARGUMENT for a bad
 * struct_bytes.
 */
BP_API bp_status bp_archive_open_source(const bp_source *source, bp_archive **out, bp_error *error);

BP_API void bp_archive_close(bp_archive *archive); /* NULL is allowed */

/* Number of materials. */
BP_API uint64_t bp_archive_count(const bp_archive *archive);

/* Bytes read from the file so far, over all threads. */
BP_API uint64_t bp_archive_bytes_read(const bp_archive *archive);

/*
 * The name of material `index`, 0 to count - 1, in the order of the names' bytes; UTF-8, NUL-terminated.
 * Reads at most one path of index pages (4096 bytes each; two or three in practice).
 * Errors: BP_ERROR_NOT_FOUND (index too large), and those of damaged or unreadable files.
 */
BP_API bp_status bp_archive_name(const bp_archive *archive, uint64_t index, char name[BP_NAME_BYTES_MAX + 1], bp_error *error);

/* The number of the material called `name`; BP_ERROR_NOT_FOUND when there is none. Reads as bp_archive_name does. */
BP_API bp_status bp_archive_find(const bp_archive *archive, const char *name, uint64_t *index, bp_error *error);

/* One layer: what loading it costs and what error is left. */
typedef struct bp_layer {
	uint32_t bytes;          /* of the record up to and including this layer, head included */
	double log_rmse;         /* rms of log10((e + 1e-3)/(b + 1e-3)) over valid cells and channels, e decoded, b measured */
	double cube_root_rmse;   /* rms of cbrt(b cos) - cbrt(e cos), cos the smaller of the two cosines at the cell's lower corner */
	double largest_relative; /* largest |e - b|/(b + 1e-2) */
	double seen_log_rmse; /* log_rmse over the valid cells that do not lie wholly below the horizon only; of float's precision */
} bp_layer;

/* One section of a record. */
typedef struct bp_section {
	uint32_t type, codec, version; /* as the format's specification numbers them */
	uint32_t layer;                /* the first layer that needs it */
	uint32_t flags;                /* bit 0: required, bit 1: colour only, bits 2, 3, 4: for channel R, G, B alone */
	uint32_t bytes;
	double error; /* its own error figure, or NaN */
} bp_section;

/*
 * Robust regression (DuMouchel and O'Brien 1989) of one channel's measured values, diffuse + specular x. Profile 1: x is the
 * channel's decoded model, over all measured cells, and decoding uses both numbers (0 and 1 where the line would lose the model).
 * Profile 2: x is the measured mean of the three channels, over some 65,000 cells: a summary, which decoding does not use.
 */
typedef struct bp_channel {
	double diffuse;  /* 1/sr */
	double specular; /* a ratio: x is in 1/sr */
	double rejected; /* share of the valid cells that the regression gave no weight */
	uint32_t iterations;
	uint32_t converged; /* 1 or 0 */
} bp_channel;

/* What a record's head says of all of it. The caller sets struct_bytes; later versions may append members. */
typedef struct bp_material_info {
	size_t struct_bytes; /* sizeof(bp_material_info), set by the caller */
	char name[BP_NAME_BYTES_MAX + 1];
	uint32_t profile;                 /* 1: paper, 2: spectral */
	uint32_t codec_version;           /* of the encoder; 0: layers have been dropped since */
	uint32_t theta_h, theta_d, phi_d; /* cells of the lattice */
	uint32_t head_bytes, record_bytes;
	uint64_t record_offset; /* in the file */
	bp_channel channels[3]; /* R, G, B */
	uint32_t layer_count;   /* up to BP_LAYERS_MAX: bp_archive_layers */
	uint32_t section_count; /* up to BP_SECTIONS_MAX: bp_archive_sections */
	uint32_t left_out;      /* pairs that are independent and not stored: bit 0 c_hd, bit 1 c_hphi, bit 2 all c_dphi|h */
	uint32_t effort;        /* options it was made with */
	uint32_t budget_bytes;
	double max_error;      /* 0: a budget was asked for */
	uint64_t source_bytes; /* of the measured file */
	uint8_t source_sha256[32];
	uint64_t source_nonfinite; /* its cells that were NaN or infinite */
	double horizon_limit;      /* the lowest cosine at which anything was measured, -1 to 0 */
	uint32_t source_holes;     /* its cells that were taken as not measured for the value they hold (bp_zeros) */
	uint32_t zeros;            /* by which rule: a bp_zeros */
} bp_material_info;

/*
 * What is known of material `index` without loading it; reads its head (about 500 bytes) beside the index.
 * Errors: BP_ERROR_ARGUMENT (struct_bytes is not that of a version of this header), BP_ERROR_NOT_FOUND, and
 * those of damaged or unreadable files.
 */
BP_API bp_status bp_archive_info(const bp_archive *archive, uint64_t index, bp_material_info *info, bp_error *error);

/*
 * The layers, or the sections, of material `index`, in their order: fills at most `capacity` elements of element_bytes =
 * sizeof(bp_layer) or sizeof(bp_section) each, and sets *count (NULL is allowed) to how many there are. Reads as bp_archive_info
 * does.
 */
BP_API bp_status bp_archive_layers(const bp_archive *archive, uint64_t index, size_t element_bytes, bp_layer *layers,
                                   uint32_t capacity, uint32_t *count, bp_error *error);
BP_API bp_status bp_archive_sections(const bp_archive *archive, uint64_t index, size_t element_bytes, bp_section *sections,
                                     uint32_t capacity, uint32_t *count, bp_error *error);

/*
 * The whole record of material `index`, checked: *record is freed with bp_free. What bp_writer_add takes, so that a record goes
 * from archive to archive without being packed again.
 */
BP_API bp_status bp_archive_record(const bp_archive *archive, uint64_t index, uint8_t **record, size_t *record_bytes,
                                   bp_error *error);

/* ---- Decoded tables ---- */

/* How a number of a table is stored, in the machine's byte order. */
typedef enum bp_number {
	BP_NUMBER_FLOAT = 0,  /* 32 bits */
	BP_NUMBER_DOUBLE = 1, /* 64 bits */
	BP_NUMBER_HALF = 2    /* 16 bits, IEEE 754 binary16, to nearest even; what exceeds 65504 is 65504 */
} bp_number;

/*
 * In which order. Cell (i, j, k) of theta_h, theta_d, phi_d has number n = k + P (j + D i) of N = H D P.
 * Planes: channel c of cell n is value n + c N, as in MERL files. Interleaved: it is value 3 n + c, a float3 or half3 per cell.
 */
typedef enum bp_layout { BP_LAYOUT_PLANES = 0, BP_LAYOUT_INTERLEAVED = 1 } bp_layout;

/* What to decode, and how to lay it out. Zeroed but for struct_bytes: the whole record, planes of float, -1 below the horizon. */
typedef struct bp_table_options {
	size_t struct_bytes; /* sizeof(bp_table_options) */
	double max_log_rmse; /* as in bp_load_options */
	bp_number number;
	bp_layout layout;
	/* 0: -1 where a cell lies below the horizon, beyond anything that was measured (bp_material_info's horizon_limit), as in
	   extracted files; 1: the model's smooth continuation there */
	int continued;
} bp_table_options;

/* Bytes of a table of H x D x P cells: 3 values each. options NULL: as if zeroed. 0 for an unknown number. */
BP_API size_t bp_table_bytes(uint32_t theta_h, uint32_t theta_d, uint32_t phi_d, const bp_table_options *options);

/*
 * Decodes material `index` into the caller's `values`, `bytes` of them, which must be bp_table_bytes of its lattice. Values are
 * in 1/sr, R G B, each of its cell's centre. This is what `brdfpack extract` writes, but for MERL's scale; what
 * bp_material_evaluate reads is rounded once more (bp_form). After a failure the values are unspecified. Needs some 17 bytes per
 * cell while it works.
 * Errors: BP_ERROR_ARGUMENT (struct_bytes, number, layout, continued, max_log_rmse, bytes), and those of bp_material_load.
 */
BP_API bp_status bp_archive_table(const bp_archive *archive, uint64_t index, const bp_table_options *options, void *values,
                                  size_t bytes, bp_error *error);

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
BP_API bp_status bp_archive_verify(const bp_archive *archive, unsigned flags, bp_problem_fn *report, void *user, bp_error *error);

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
	/* 16 bits per value, relative error at most 2^-11 of the decoded value; 8.8 MB / 2.9 MB */
	BP_FORM_EXPANDED = 0,
	/* 8 bits per value, shared scales and colours: some 0.001 in log RMSE more, 0.01 where channels end at 0; 2.6 MB / 2.0 MB */
	BP_FORM_COMPACT = 1,
	/* expanded, but only every second value along each axis, each where it stands, and quicker to load: for a look, with the
	   first layer; 1.1 MB, in a page of 2 MB where the system gives one, / 0.4 MB. Where an extent of the lattice is odd, all
	   values are loaded */
	BP_FORM_PREVIEW = 2
} bp_form;

typedef enum bp_colour {
	BP_COLOUR_RGB = 0,
	BP_COLOUR_MEAN = 1, /* achromatic: the mean of the channels, given back in all three; sections for colour are not read */
	/* one channel, given back in all three. Of profile 1 only its sections are read, about a third; records of other profiles do
	   not keep channels apart: BP_ERROR_UNSUPPORTED */
	BP_COLOUR_R = 2,
	BP_COLOUR_G = 3,
	BP_COLOUR_B = 4
} bp_colour;

/*
 * Where the memory comes from that a material keeps. alloc returns `bytes` bytes at a multiple of `alignment` (a power of two up
 * to 2^21), or NULL; release takes back what alloc gave. Both are called within bp_material_load and bp_material_free only, by
 * the calling thread.
 */
typedef struct bp_allocator {
	void *(*alloc)(void *user, size_t bytes, size_t alignment);
	void (*release)(void *user, void *block);
	void *user;
} bp_allocator;

/* What to load. Zeroed but for struct_bytes it asks for the whole record, in RGB, expanded, without sampling. */
typedef struct bp_load_options {
	size_t struct_bytes; /* sizeof(bp_load_options) */
	double max_log_rmse; /* > 0: the fewest layers whose seen_log_rmse is at most this, all when none is; 0: all */
	bp_form form;
	bp_colour colour;
	int sampling; /* 1: also build the tables of bp_material_sample, _pdf and _albedo (0.2 MB); else 0 */
	/* NULL: malloc. Copied; all that bp_loaded counts in memory_bytes comes from it, and what is needed only while loading from
	   malloc */
	const bp_allocator *allocator;
	/* refuse, with BP_ERROR_LIMIT, a material that may need more while it is loaded: 24 bytes per cell and 1 MB, 36 MB for MERL's
	   lattice; more where phi_d has few cells (of 4: 59 bytes per cell) or hundreds (of P: up to P^3/3 bytes more). 0: twice
	   MERL's need, 72 MB; an archive's few bytes may ask for gigabytes */
	size_t max_memory_bytes;
} bp_load_options;

/* What was loaded. */
typedef struct bp_loaded {
	size_t struct_bytes; /* sizeof(bp_loaded), set by the caller */
	uint32_t layers;     /* of the record's layers */
	double log_rmse; /* theirs as in bp_layer, cells below the horizon included: may exceed max_log_rmse, which leaves them out */
	uint32_t read_bytes; /* of the record: its head and the sections needed */
	size_t memory_bytes; /* all that the material occupies */
	bp_form form;
	bp_colour colour;
	int sampling;
	uint32_t theta_h, theta_d, phi_d; /* values along each axis: the lattice's cells, of a preview half of them */
} bp_loaded;

/*
 * Loads material `index` of the archive; options NULL: as if zeroed. The caller frees *out. Several threads
 * may load from one archive at once. The bits do not depend on the caller's rounding mode or flushing of denormals. Beside the
 * result it needs 2 to 17 bytes per cell while it works, at most 25 MB for a MERL lattice; more only for records of
 * megabytes, and for lattices of few or of hundreds of cells along phi_d (max_memory_bytes).
 * Errors: BP_ERROR_ARGUMENT (struct_bytes, an unknown form or colour, sampling neither 0 nor 1, max_log_rmse negative
 * or NaN, an allocator without both functions), BP_ERROR_NOT_FOUND, BP_ERROR_LIMIT (max_memory_bytes), BP_ERROR_UNSUPPORTED (one
 * channel of profile 2), BP_ERROR_MEMORY, and those of damaged or unreadable files.
 */
BP_API bp_status bp_material_load(const bp_archive *archive, uint64_t index, const bp_load_options *options, bp_material **out,
                                  bp_error *error);
BP_API void bp_material_free(bp_material *material); /* NULL is allowed */

/* Fills *loaded; BP_ERROR_ARGUMENT when struct_bytes is not that of a version of this header. */
BP_API bp_status bp_material_loaded(const bp_material *material, bp_loaded *loaded, bp_error *error);

/* f(wi, wo), interpolated. An unusable direction gives 0. */
BP_API void bp_material_evaluate(const bp_material *material, const float wi[3], const float wo[3], float rgb[3]);

/*
 * f of the cell into which the directions fall, as the MERL database's own look-up gives it; of a preview, of the first of two
 * cells along each axis.
 */
BP_API void bp_material_nearest(const bp_material *material, const float wi[3], const float wo[3], float rgb[3]);

/*
 * bp_material_evaluate for `count` pairs in separate arrays of components: wi[0] holds the x of every wi, and so on.
 * The same values to the bit, several times faster from some dozens on. Outputs must not overlap anything else. With a
 * count of 0 the arrays are not looked at.
 */
BP_API void bp_material_evaluate_batch(const bp_material *material, size_t count, const float *const wi[3],
                                       const float *const wo[3], float *const rgb[3]);

/*
 * Draws wi for wo, nearly in proportion to f cos theta_i, from three independent uniform numbers in [0, 1).
 * Returns its density per solid angle, exactly what bp_material_pdf returns for the pair; wi has unit length and
 * z > 0, and the weight f cos theta_i / pdf is finite. Numbers outside [0, 1) are clamped, NaN counts as 0.
 * An unusable wo, or a material that was loaded without sampling, gives density 0 and wi = 0.
 */
BP_API float bp_material_sample(const bp_material *material, const float wo[3], const float u[3], float wi[3]);

/*
 * The density of bp_material_sample. Over the hemisphere of wi it integrates to 1 and is above 0 everywhere. An unusable
 * direction, or a material that was loaded without sampling, gives 0.
 */
BP_API float bp_material_pdf(const bp_material *material, const float wi[3], const float wo[3]);

/*
 * The directional albedo: the integral of f cos theta_i over wi, for theta_o in radians in [0, pi/2). Other angles, NaN, and
 * a material that was loaded without sampling give 0. Measurements can exceed 1. Some milliseconds (a quadrature)
 * when an angle is asked for first, some ten nanoseconds when it or those around it were; the value is the same.
 */
BP_API void bp_material_albedo(const bp_material *material, float theta_o, float rgb[3]);

/*
 * bp_material_sample and bp_material_pdf for `count` directions or pairs in separate arrays of components, as in
 * bp_material_evaluate_batch; the same values to the bit. Outputs must not overlap anything else.
 */
BP_API void bp_material_sample_batch(const bp_material *material, size_t count, const float *const wo[3], const float *const u[3],
                                     float *const wi[3], float *pdf);
BP_API void bp_material_pdf_batch(const bp_material *material, size_t count, const float *const wi[3], const float *const wo[3],
                                  float *pdf);

/*
 * The albedo as a table over the cosine: rgb[3 n + c] is bp_material_albedo where cos theta_o = (n + 1/2)/count. Renderers on
 * graphics processors keep 256 of them, as a texture that is looked up at cos theta_o. BP_ERROR_ARGUMENT where count is 0 or
 * above 65536, or the material was loaded without sampling. All angles for the first time take some 0.1 s.
 */
BP_API bp_status bp_material_albedo_table(const bp_material *material, size_t count, float *rgb, bp_error *error);

/* ---- Packing ---- */

/* One measured material in memory. The caller sets struct_bytes and owns all that it points to. */
typedef struct bp_measured {
	size_t struct_bytes;              /* sizeof(bp_measured) */
	uint32_t theta_h, theta_d, phi_d; /* cells along each axis: 4 to 1024 each, at most 2^24 in all */
	bp_number number;                 /* BP_NUMBER_FLOAT or BP_NUMBER_DOUBLE */
	bp_layout layout;
	const void *values;        /* 3 per cell, R G B, of its centre (see bp_material), in `layout` */
	const uint8_t *mask;       /* NULL, or per cell, 0: not measured */
	double scale[3];           /* times a value this is 1/sr; all 0: 1. MERL files: 1/1500, 1.15/1500, 1.66/1500 */
	uint64_t source_bytes;     /* of the file that it comes from; recorded, 0: none */
	uint8_t source_sha256[32]; /* of that file; recorded, zeros: none */
} bp_measured;

/*
 * Is told how much of the work is done, from 0 to 1, by the calling thread, many times; a result other than 0 cancels, after
 * which nothing is left. A share may be told twice, and falls back where records of several sizes are tried (max_error).
 */
typedef int bp_progress_fn(void *user, double share);

/*
 * What cells mean that are 0 in all channels. Who reads a measured file that marks what was not measured by negative values,
 * clamps these at 0 and writes it back, has lost the marks; packed as black they spoil what is next to them.
 *
 * BP_ZEROS_AUTO: where no value is negative and the cells below the horizon, or those below some cosine under it, hold one value,
 * 0 or another one that little else holds, they are holes: not measured. A mask says more: with a cell of mask 0 nothing is done.
 * Cells above the horizon stay what they are, black where they are 0.
 * BP_ZEROS_HOLES: besides, every cell that is 0 in all channels is a hole. BP_ZEROS_MEASURED: values are taken as they are.
 */
typedef enum bp_zeros { BP_ZEROS_AUTO = 0, BP_ZEROS_HOLES = 1, BP_ZEROS_MEASURED = 2 } bp_zeros;

/* How to pack: what `brdfpack build` has as options. Zeroed but for struct_bytes: its defaults. */
typedef struct bp_pack_options {
	size_t struct_bytes;      /* sizeof(bp_pack_options) */
	uint32_t profile;         /* 1: paper, 2 or 0: spectral */
	uint32_t budget_bytes;    /* largest record, 1000 to 4,000,000; 0: 60,400 */
	double max_error;         /* > 0, 1e-6 to 10: the smallest record whose log_rmse is at most this, and no budget_bytes */
	uint32_t effort;          /* 1 to 9; 0: 5 */
	bp_progress_fn *progress; /* NULL: none */
	void *user;               /* its first argument */
	uint32_t zeros;           /* a bp_zeros; bp_material_info's source_holes says what came of it */
} bp_pack_options;

/*
 * Packs one material under a name (UTF-8, 1 to 255 bytes, no control character, no `/`, not `.` or `..`) into a record, which is
 * freed with bp_free. A cell with a mask of 0, or any channel that is negative, NaN or infinite, counts as not measured; values
 * above 2^1015 count as that. The record depends on the values, name, source and options only: with those of a file it is the one
 * that `brdfpack build` makes: values of an extracted file, as double planes with MERL's scale and no mask, give the record that
 * they carry, where `build` would keep it. Uses the calling thread; several may pack at once. options NULL: as if zeroed. Needs
 * some 90 MB for a MERL lattice.
 * Errors: BP_ERROR_ARGUMENT (struct_bytes, an option, the name), BP_ERROR_LIMIT (the extents, or a budget or bound that cannot be
 * kept), BP_ERROR_BAD_INPUT (no valid cell), BP_ERROR_CANCELLED, BP_ERROR_MEMORY.
 */
BP_API bp_status bp_pack(const bp_measured *measured, const char *name, const bp_pack_options *options, uint8_t **record,
                         size_t *record_bytes, bp_error *error);

/* A copy of a record under another name, freed with bp_free. The record is checked as bp_writer_add does. */
BP_API bp_status bp_record_rename(const uint8_t *record, size_t record_bytes, const char *name, uint8_t **out, size_t *out_bytes,
                                  bp_error *error);

/* ---- Writing archives ---- */

/*
 * An archive under construction: it keeps copies of its records in memory until it is whole. For one thread at a time.
 */
typedef struct bp_writer bp_writer;

BP_API bp_status bp_writer_create(bp_writer **out, bp_error *error);
BP_API void bp_writer_free(bp_writer *writer); /* NULL is allowed; nothing is written */

/*
 * Adds one record, in any order of names; copies it. Head and checksums are checked.
 * Errors: BP_ERROR_ARGUMENT for a name that is there already, BP_ERROR_MEMORY, and those of damaged records. The writer is as
 * before then.
 */
BP_API bp_status bp_writer_add(bp_writer *writer, const uint8_t *record, size_t record_bytes, bp_error *error);

/* How many records it has. */
BP_API uint64_t bp_writer_count(const bp_writer *writer);

/*
 * Writes the archive to a file beside `path`, syncs it, and renames it over `path`: what was there before, whatever it was, stays
 * as it was unless all of this succeeds. A link is followed; mode and owner are kept. Where only the folder could not be synced
 * after that, this is BP_OK, and the error's message says so; otherwise it is empty then. The writer stays usable.
 * Errors: BP_ERROR_IO, BP_ERROR_MEMORY, BP_ERROR_ARGUMENT for an empty path.
 */
BP_API bp_status bp_writer_save(const bp_writer *writer, const char *path, bp_error *error);

/* The same into memory: *bytes is freed with bp_free. The bytes are those that bp_writer_save writes. */
BP_API bp_status bp_writer_save_memory(const bp_writer *writer, uint8_t **bytes, size_t *count, bp_error *error);

#ifdef __cplusplus
}
#endif

#endif
