#!/usr/bin/env python3
"""The Python package against the tool and against itself: python_package.py TOOL (in an environment that has the package)."""
import copy
import gc
import multiprocessing
import os
import pickle
import signal
import subprocess
import sys
import tempfile
import threading
import time
import unittest
import warnings

import numpy as np

import brdfpack

TOOL = os.path.abspath(sys.argv.pop(1))
DIMS = (12, 10, 16)
MERL_SCALE = np.array([1.0 / 1500, 1.15 / 1500, 1.66 / 1500])
scratch = tempfile.TemporaryDirectory()
HERE = scratch.name


def tool(*arguments):
    return subprocess.run([TOOL, *arguments], check=True, capture_output=True, cwd=HERE).stdout


def directions(count, seed):
    v = np.random.default_rng(seed).normal(size=(count, 3)).astype(np.float32)
    v[:, 2] = abs(v[:, 2])
    return v / np.linalg.norm(v, axis=1, keepdims=True)


def setUpModule():
    tool("synth", "--lattice", "x".join(map(str, DIMS)), "materials")
    tool("build", "-q", "--any-lattice", "-o", "demo.bpk", "materials")
    tool("extract", "-C", "extracted", "--plain", "demo.bpk")


def demo():
    return brdfpack.open(os.path.join(HERE, "demo.bpk"))


class Archives(unittest.TestCase):
    def test_is_a_mapping_from_names(self):
        with demo() as archive:
            listed = tool("list", "--json", "demo.bpk").decode()
            names = list(archive)
            self.assertEqual(len(archive), len(names))
            self.assertEqual(names, sorted(names))
            self.assertTrue(all(f'"name": "{name}"' in listed for name in names))
            self.assertIn(names[3], archive)
            self.assertNotIn("no-such", archive)
            self.assertNotIn(7, archive)
            self.assertEqual([key for key, _ in archive.items()], names)
            self.assertIsNone(archive.get("no-such"))
            with self.assertRaises(KeyError) as caught:
                archive["no-such"]
            self.assertEqual(str(caught.exception), 'there is no material "no-such"')
            info = archive[names[0]].info
            self.assertEqual((info.shape, info.profile, info.name), (DIMS, "spectral", names[0]))
            self.assertEqual(info.layers[-1].bytes, info.record_bytes)
            self.assertEqual(sum(s.bytes for s in info.sections) + info.head_bytes, info.record_bytes)
            self.assertEqual(archive.verify(deep=True), [])

    def test_refusals_are_exceptions(self):
        with self.assertRaises(FileNotFoundError):
            brdfpack.open(os.path.join(HERE, "none.bpk"))
        with self.assertRaises(brdfpack.Error) as caught:
            brdfpack.open(TOOL)
        self.assertEqual(caught.exception.status, 4)
        self.assertIn(TOOL, str(caught.exception))
        with self.assertRaisesRegex(brdfpack.Error, "^in memory: not an archive: "):
            brdfpack.open(b"")
        with self.assertRaises(TypeError):
            brdfpack.open(3.5)
        again = pickle.loads(pickle.dumps(caught.exception))
        self.assertEqual((again.status, str(again)), (4, str(caught.exception)))

    def test_names_are_taken_whole(self):
        """C's strings end at a NUL, and UTF-8 has no lone surrogates."""
        with demo() as archive:
            first = list(archive)[0]
            for name in (first + "\0", first + "\0more", first[:2] + "\ud800", "\udcff"):
                self.assertNotIn(name, archive)
                with self.assertRaises(KeyError):
                    archive[name]
            record, writer = archive[first].record(), brdfpack.Writer(None)
            for name in ("a\0b", "\ud800"):
                with self.assertRaisesRegex(ValueError, "not a legal name"):
                    writer.add(name, record)
                with self.assertRaisesRegex(ValueError, "not a legal name"):
                    brdfpack.pack(archive[first].table(), name=name)
            with self.assertRaises(TypeError):
                writer.add(3, record)
        with self.assertRaisesRegex(ValueError, "null byte"):
            brdfpack.Writer(os.path.join(HERE, "out\0.bpk"))
        with self.assertRaisesRegex(ValueError, "null byte"):
            brdfpack.open(os.path.join(HERE, "demo.bpk\0"))

    def test_damage_is_reported(self):
        with open(os.path.join(HERE, "demo.bpk"), "rb") as file:
            whole = file.read()
        with demo() as archive:
            name = list(archive)[2]
            info = archive[name].info
        at = info.record_offset + info.record_bytes - 1
        with brdfpack.open(whole[:at] + bytes([whole[at] ^ 1]) + whole[at + 1:]) as archive:
            problems = archive.verify()
            self.assertEqual([p.material for p in problems], [name])
            self.assertEqual(problems[0].error.status, 7)
            for call in (archive.load, lambda name: archive[name].table(), lambda name: archive[name].record()):
                with self.assertRaisesRegex(brdfpack.Error, f"^in memory: {name}: corrupt at offset [0-9]+: the checksum of "):
                    call(name)

    def test_bytes_give_what_the_file_gives(self):
        with open(os.path.join(HERE, "demo.bpk"), "rb") as file:
            inside = brdfpack.open(file.read())
        gc.collect()
        with demo() as archive:
            self.assertEqual(list(archive), list(inside))
            for name in archive:
                self.assertEqual(archive[name].record(), inside[name].record())

    def test_tables_are_those_that_extract_writes(self):
        with demo() as archive:
            for name in archive:
                written = np.fromfile(os.path.join(HERE, "extracted", name + ".binary"), "<f8", offset=12).reshape((3,) + DIMS)
                table = archive[name].table(dtype="float64")
                below = written[0] < 0
                self.assertTrue(below.any() and ((table < 0) == below[..., None]).all())
                np.testing.assert_allclose(table[~below], np.moveaxis(written * MERL_SCALE[:, None, None, None], 0, -1)[~below], rtol=1e-15)
                continued = archive[name].table(continued=True)
                self.assertTrue((continued >= 0).all())
                np.testing.assert_array_equal(continued[~below], table[~below].astype(np.float32))
                np.testing.assert_array_equal(archive[name].table(dtype=np.float16)[~below], np.minimum(table, 65504).astype(np.float16)[~below])
                material = archive.load(name)
                np.testing.assert_array_equal(material.table(dtype="float64"), table)
            with self.assertRaises(TypeError):
                archive[name].table(dtype="int32")

    def test_closed_archives_say_so_and_materials_go_on(self):
        archive = demo()
        entry, material = archive[list(archive)[0]], archive.load(list(archive)[0], sampling=True)
        archive.close()
        archive.close()
        for call in (lambda: len(archive), lambda: list(archive), lambda: entry.info, lambda: entry.load(), lambda: archive.verify()):
            with self.assertRaisesRegex(ValueError, "closed"):
                call()
        self.assertEqual(material.table().shape, DIMS + (3,))
        self.assertTrue((material.evaluate([0, 0.6, 0.8], [0, 0, 1]) >= 0).all())

    def test_pickle_is_refused_with_a_sentence(self):
        with demo() as archive:
            material = archive.load(list(archive)[0])
            for thing in (archive, archive[list(archive)[0]], material, brdfpack.Writer(None)):
                for way in (pickle.dumps, copy.copy, copy.deepcopy):
                    with self.assertRaisesRegex(TypeError, "open the archive anew"):
                        way(thing)


class Materials(unittest.TestCase):
    def setUp(self):
        with demo() as archive:
            self.name = list(archive)[4]
            self.material = archive.load(self.name, sampling=True)

    def test_values_do_not_depend_on_how_arrays_lie(self):
        wi, wo = directions(1031, 1), directions(1031, 2)
        expected = self.material.evaluate(wi, wo)
        self.assertEqual((expected.shape, expected.dtype), ((1031, 3), np.float32))
        one = np.stack([self.material.evaluate(a, b) for a, b in zip(wi, wo)])
        np.testing.assert_array_equal(one, expected)
        strided = np.zeros((1031, 7), np.float32)
        strided[:, ::3] = wi
        byte = np.zeros(4 * wi.size + 1, np.uint8)
        odd = byte[1:].view(np.float32).reshape(wi.shape)
        odd[:] = wi
        frozen = wi.copy()
        frozen.flags.writeable = False
        ways = (np.asfortranarray(wi), strided[:, ::3], odd, frozen, wi.astype(np.float64), wi.astype(">f4"), wi.tolist(), wi[::-1].copy()[::-1])
        for other in ways:
            np.testing.assert_array_equal(self.material.evaluate(other, wo), expected)
        np.testing.assert_array_equal(self.material.evaluate(wi.reshape(1031, 1, 3), wo[:5]), np.stack([self.material.evaluate(wi, wo[n:n + 1]) for n in range(5)], 1))
        np.testing.assert_array_equal(self.material.evaluate(wi, wo[0]), self.material.evaluate(wi, np.repeat(wo[:1], 1031, 0)))
        out = np.empty((1031, 3), np.float32)
        self.assertIs(self.material.evaluate(wi, wo, out=out), out)
        np.testing.assert_array_equal(out, expected)

    def test_wrong_arrays_are_refused(self):
        wi = directions(4, 1)
        for bad in (wi[:, :2], np.float32(3), np.zeros((4, 0)), wi.T):
            with self.assertRaises(ValueError):
                self.material.evaluate(bad, wi)
        with self.assertRaisesRegex(ValueError, "do not go together"):
            self.material.evaluate(wi, directions(5, 1))
        for bad in (wi.astype(complex), np.array([["a", "b", "c"]]), np.array([[None] * 3]), wi > 0):
            with self.assertRaises(TypeError):
                self.material.evaluate(bad, wi)
        frozen = np.empty((4, 3), np.float32)
        frozen.flags.writeable = False
        for out in (np.empty((4, 3)), np.empty((3, 3), np.float32), np.empty((8, 3), np.float32)[::2], frozen, [0]):
            with self.assertRaises(ValueError):
                self.material.evaluate(wi, wi, out=out)

    def test_out_that_overlaps_is_refused(self):
        both = np.zeros((9, 3), np.float32)
        both[:, 2] = 1
        for out in (both, both[:5]):
            with self.assertRaisesRegex(ValueError, "overlaps"):
                self.material.evaluate(both[4:] if len(out) == 5 else both, [0, 0, 1], out=out)

    def test_unusable_directions_and_empty_arrays(self):
        self.assertEqual(self.material.evaluate(np.zeros((0, 3)), np.zeros((0, 3))).shape, (0, 3))
        self.assertEqual(self.material.sample(np.zeros((0, 3)), np.zeros((0, 3))).pdf.shape, (0,))
        self.assertEqual(self.material.albedo([]).shape, (0, 3))
        bad = np.array([[np.nan, 0, 1], [0, 0, 0], [1e300, 0, -1], [np.inf, 0, 1]])
        self.assertTrue((self.material.evaluate(bad, [0, 0, 1]) == 0).all())
        self.assertTrue((self.material.pdf(bad, [0, 0, 1]) == 0).all())
        wi, pdf = self.material.sample(bad, np.full((4, 3), 0.5))
        self.assertTrue((wi == 0).all() and (pdf == 0).all())

    def test_sampling_fits_its_density_and_the_albedo(self):
        count = 200_000
        wo = np.array([0.5, 0.1, 0.8]) / np.linalg.norm([0.5, 0.1, 0.8])
        wi, pdf = self.material.sample(np.broadcast_to(wo, (count, 3)), np.random.default_rng(3).random((count, 3)))
        np.testing.assert_array_equal(pdf, self.material.pdf(wi, wo))
        mean = (self.material.evaluate(wi, wo) * (wi[:, 2:] / pdf[:, None]).astype(np.float64)).mean(0)
        albedo = self.material.albedo(np.arccos(wo[2]))
        self.assertEqual(albedo.shape, (3,))
        np.testing.assert_allclose(mean, albedo, rtol=0.02)
        self.assertEqual(self.material.albedo(np.zeros((2, 5))).shape, (2, 5, 3))

    def test_options_are_heeded_and_checked(self):
        with demo() as archive:
            few = archive.load(self.name, max_error=10)
            self.assertEqual(few.layers, 1)
            self.assertEqual(archive.load(self.name, form="preview").shape, (6, 5, 8))
            self.assertLess(archive.load(self.name, form="compact").memory_bytes, archive.load(self.name).memory_bytes)
            grey = archive.load(self.name, colour="mean").evaluate(directions(9, 1), directions(9, 2))
            self.assertTrue((grey == grey[:, :1]).all())
            with self.assertRaisesRegex(ValueError, "sampling=True"):
                few.pdf([0, 0, 1], [0, 0, 1])
            for bad in ({"form": "fine"}, {"colour": "red"}):
                with self.assertRaises(ValueError):
                    archive.load(self.name, **bad)
            with self.assertRaises(brdfpack.Error):
                archive.load(self.name, max_error=-1)

    def test_threads_and_forks(self):
        wi, wo = directions(20000, 1), directions(20000, 2)
        expected = self.material.evaluate(wi, wo)
        failures = []

        def work():
            for _ in range(20):
                if not (self.material.evaluate(wi, wo) == expected).all():
                    failures.append(1)
                with demo() as archive:
                    archive.load(self.name)

        threads = [threading.Thread(target=work) for _ in range(4)]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()
        self.assertEqual(failures, [])
        # an archive that closes while another thread reads it
        archive = demo()
        reader = threading.Thread(target=lambda: [archive[name].record() for name in list(archive)] if not archive._closed else None)
        reader.start()
        reader.join()
        archive.close()

        archive = demo()
        child = os.fork()
        if child == 0:
            same = (self.material.evaluate(wi, wo) == expected).all() and (archive.load(self.name).evaluate(wi, wo) == expected).all()
            os._exit(0 if same else 1)
        self.assertEqual(os.waitpid(child, 0)[1], 0)


class Packing(unittest.TestCase):
    def table(self):
        with demo() as archive:
            return archive[list(archive)[4]].table()

    def test_files_are_packed_as_build_packs_them(self):
        with demo() as archive:
            for name in archive:
                self.assertEqual(brdfpack.pack(os.path.join(HERE, "materials", name + ".binary")), archive[name].record())

    def test_extracted_files_keep_their_records(self):
        """As `build` does with the same options; a mask or another profile has them packed anew."""
        tool("build", "-q", "--any-lattice", "--budget", "5000", "-o", "small.bpk", "materials")  # which such small tables can carry
        tool("extract", "-C", "carrying", "small.bpk")
        with brdfpack.open(os.path.join(HERE, "small.bpk")) as archive:
            for name in list(archive)[:4]:
                path, record = os.path.join(HERE, "carrying", name + ".binary"), archive[name].record()
                self.assertEqual(brdfpack.pack(path), record)
                with brdfpack.open(self.archive_of("new", brdfpack.pack(path, name="other"))) as renamed:
                    self.assertEqual(renamed["new"].info.source_sha256, archive[name].info.source_sha256)
                for anew in ({"profile": "paper"}, {"budget": len(record) - 1}, {"mask": np.ones(DIMS)}):
                    self.assertNotEqual(brdfpack.pack(path, **anew), record)
                self.assertNotEqual(brdfpack.pack(os.path.join(HERE, "extracted", name + ".binary")), record)
        for options in (("--profile", "paper"), ("--max-error", "0.05"), ("--budget", "9000")):
            tool("build", "-q", "--any-lattice", "--force", *options, "-o", "again.bpk", "carrying")
            value = options[1] if options[0] == "--profile" else float(options[1]) if "." in options[1] else int(options[1])
            with brdfpack.open(os.path.join(HERE, "again.bpk")) as again:
                path = os.path.join(HERE, "carrying", name + ".binary")
                self.assertEqual(brdfpack.pack(path, **{options[0][2:].replace("-", "_"): value}), again[name].record())

    def test_tables_of_all_kinds_give_the_same_record(self):
        table = self.table()
        expected = brdfpack.pack(table, budget=16_000)
        self.assertLessEqual(len(expected), 16_000)
        frozen = table.copy()
        frozen.flags.writeable = False
        for other in (table.astype(np.float64), np.asfortranarray(table), frozen, table[::-1].copy()[::-1], table.astype(">f8")):
            self.assertEqual(brdfpack.pack(other, budget=16_000), expected)
        holes = table.copy()
        holes[table[..., 0] < 0] = np.nan
        marked = brdfpack.pack(np.where(table < 0, 7, table), budget=16_000, mask=table[..., 0] >= 0)
        self.assertEqual(marked, expected)
        with brdfpack.open(self.archive_of("material", brdfpack.pack(holes))) as archive:
            self.assertEqual(archive["material"].info.source_nonfinite, int(np.isnan(holes[..., 0]).sum()))

    def test_holes_written_as_zero(self):
        table = self.table()
        clamped = np.maximum(table, 0)
        with self.assertWarnsRegex(UserWarning, "not measured"):
            record = brdfpack.pack(clamped, budget=16_000)
        kept = brdfpack.pack(table, budget=16_000)
        def apart_from_holes(packed):  # nor the checksum over them
            head_bytes = int.from_bytes(packed[8:12], "little")
            return packed[:52] + packed[56:head_bytes - 4] + packed[head_bytes:]

        self.assertEqual(apart_from_holes(record), apart_from_holes(kept))
        with warnings.catch_warnings():
            warnings.simplefilter("error")
            self.assertNotEqual(brdfpack.pack(clamped, budget=16_000, zeros="measured"), record)
            every = brdfpack.pack(clamped, budget=16_000, zeros="holes")
        for packed, rule in ((record, "auto"), (every, "holes")):
            with brdfpack.open(self.archive_of("material", packed)) as archive:
                info = archive["material"].info
                self.assertEqual((info.source_holes, info.zeros), (int((table[..., 0] < 0).sum()), rule))
        with self.assertRaises(ValueError):
            brdfpack.pack(table, zeros="maybe")

    @staticmethod
    def archive_of(name, record):
        writer = brdfpack.Writer(None)
        writer.add(name, record)
        return writer.bytes()

    def test_wrong_input_is_refused(self):
        table = self.table()
        for bad, kind in ((table[..., :2], ValueError), (table[0], ValueError), (np.zeros((0, 0, 0, 3)), brdfpack.Error), (table.astype(complex), TypeError),
                          (np.full(DIMS + (3,), np.nan), brdfpack.Error), (table[:3], brdfpack.Error), (-np.ones(DIMS + (3,)), brdfpack.Error)):
            with self.assertRaises(kind):
                brdfpack.pack(bad)
        for options in ({"budget": 10}, {"max_error": -1}, {"effort": 11}, {"name": "a/b"}, {"name": ""}, {"budget": 2**31}):
            with self.assertRaises(brdfpack.Error):
                brdfpack.pack(table, **options)
        for options in ({"budget": 9000, "max_error": 0.1}, {"profile": "best"}, {"effort": 0}, {"effort": -1}, {"budget": 0}, {"budget": 2**40},
                        {"max_error": 0}, {"mask": np.ones((2, 2, 2))}):
            with self.assertRaises(ValueError):
                brdfpack.pack(table, **options)
        for options in ({"effort": "5"}, {"budget": 1e4}, {"name": b"x"}, {"progress": 3}):
            with self.assertRaises(TypeError):
                brdfpack.pack(table, **options)
        with self.assertRaisesRegex(TypeError, "masked array"):
            brdfpack.pack(np.ma.masked_less(table, 0))
        with self.assertRaises(FileNotFoundError):
            brdfpack.pack(os.path.join(HERE, "none.binary"))
        for data in (b"", b"abc", bytes(40), b"\x0c\0\0\0\x0a\0\0\0\x10\0\0\0" + bytes(9)):
            path = os.path.join(HERE, "bad.binary")
            with open(path, "wb") as file:
                file.write(data)
            with self.assertRaises(brdfpack.Error):
                brdfpack.pack(path)

    def test_writers_publish_whole_or_not_at_all(self):
        path = os.path.join(HERE, "out.bpk")
        record = brdfpack.pack(self.table(), name="own")
        with brdfpack.Writer(path) as writer:
            writer.add("zinc", record)
            writer.add("mine", record)
            writer.add(None, record)
            self.assertEqual(len(writer), 3)
            with self.assertRaises(brdfpack.Error):
                writer.add("mine", record)
            with self.assertRaises(brdfpack.Error):
                writer.add("cut", record[:-1])
            with self.assertRaises(TypeError):
                writer.add("list", [1, 2])
            self.assertFalse(os.path.exists(path))
        with brdfpack.open(path) as archive:
            self.assertEqual(list(archive), ["mine", "own", "zinc"])
            self.assertEqual(archive["own"].record(), record)
        with open(path, "rb") as file:
            before = file.read()
        with self.assertRaises(RuntimeError):
            with brdfpack.Writer(path) as writer:
                raise RuntimeError
        with open(path, "rb") as file:
            self.assertEqual(file.read(), before)
        with self.assertRaises(ValueError):
            writer.add("late", record)
        with self.assertRaises(brdfpack.Error):
            with brdfpack.Writer(os.path.join(HERE, "no", "folder.bpk")) as writer:
                writer.add(None, record)
        self.assertEqual([name for name in os.listdir(HERE) if "partial" in name or "tmp" in name], [])

    def test_progress_is_told_and_what_it_raises_comes_out(self):
        shares = []
        brdfpack.pack(self.table(), progress=shares.append)
        self.assertTrue(len(shares) >= 5 and min(shares) == 0 and max(shares) <= 1)

        def stop(share):
            if share > 0.3:
                raise LookupError("enough")

        with self.assertRaisesRegex(LookupError, "enough"):
            brdfpack.pack(self.table(), progress=stop)

    def test_an_interrupt_ends_it(self):
        table = np.abs(np.random.default_rng(1).normal(size=(90, 90, 180, 3)))
        pressed = []

        def press():
            pressed.append(time.monotonic())
            os.kill(os.getpid(), signal.SIGINT)

        # a shell that starts jobs in the background lets them ignore it
        self.addCleanup(signal.signal, signal.SIGINT, signal.signal(signal.SIGINT, signal.default_int_handler))
        timer = threading.Timer(0.5, press)
        timer.start()
        with self.assertRaises(KeyboardInterrupt):
            while True:  # a fast machine packs one before the key is pressed
                brdfpack.pack(table, effort=9)
        took = time.monotonic() - pressed[0]
        print(f"interrupted within {took:.3f} s; 0.2 are asked for", file=sys.stderr)
        self.assertLess(took, 2)  # a busy machine is no failure

    def test_several_threads_pack_at_once(self):
        table = self.table()
        expected, got = brdfpack.pack(table), []
        threads = [threading.Thread(target=lambda: got.append(brdfpack.pack(table))) for _ in range(4)]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()
        self.assertEqual(got, [expected] * 4)


class Versions(unittest.TestCase):
    def test_package_library_and_tool_have_one_version(self):
        from importlib.metadata import version
        self.assertEqual(tool("--version").decode().split()[1], brdfpack.__version__)
        self.assertEqual(version("brdfpack"), brdfpack.__version__)


if __name__ == "__main__":
    multiprocessing.set_start_method("spawn")
    unittest.main()
