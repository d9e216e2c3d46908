"""The package computes what the compiler states, and reports what goes wrong.

SDFC_LIBRARY names the library; without it, the one in the package is tested.
"""

import gc
import math
import os
import re
import signal
import tempfile
import unittest
import unittest.mock
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import numpy as np

import sdfc
from sdfc import _native

ROOT = Path(__file__).resolve().parents[3]
HEADER = ROOT / "crates/capi/sdfc.h"
PAGES = [ROOT / "docs/python.md", ROOT / "packaging/python/README.md"]
SHELL = "param r = 0.5 in 0.1..1\n(sphere(r) - box([0.2, 0.2, 2])).color(#f00)"


def shell_distance(points: np.ndarray, radius: float) -> np.ndarray:
    """The field of SHELL, by the formulas of sphere and box."""
    q = np.abs(points) - [0.1, 0.1, 1]
    box = np.linalg.norm(np.maximum(q, 0), axis=-1) + np.minimum(q.max(axis=-1), 0)
    return np.maximum(np.linalg.norm(points, axis=-1) - radius, -box)


def points(count: int) -> np.ndarray:
    return np.random.default_rng(1).uniform(-1.5, 1.5, (count, 3))


class Declarations(unittest.TestCase):
    def test_functions_are_declared_as_in_the_header(self) -> None:
        source = re.sub(r"/\*.*?\*/", "", HEADER.read_text(), flags=re.DOTALL)
        found = re.findall(r"^([a-z][\w \*]*?)\b(sdfc_\w+)\(([^;]*?)\);", source, re.MULTILINE)
        header = {name: (result.strip(), arguments) for result, name, arguments in found}
        self.assertIn("sdfc_compile", header)
        sizes = {"double": 8, "uint32_t": 4, "size_t": 8, "sdfc_status": 4, "void": 0}

        def size(declared: str) -> int:
            is_pointer = "*" in declared or re.match(r"sdfc_(read|progress)\b", declared)
            return 8 if is_pointer else sizes[declared.split()[0]]

        def of(kind: object) -> int:
            return 0 if kind is None else _native.ctypes.sizeof(kind)

        for name, (result, arguments) in _native._FUNCTIONS.items():
            with self.subTest(name):
                returned, declared = header[name]
                taken = [] if declared == "void" else declared.split(",")
                taken = [size(argument.strip()) for argument in taken]
                self.assertEqual([of(kind) for kind in arguments], taken)
                self.assertEqual(of(result), size(returned))


class Field(unittest.TestCase):
    def test_distances_are_those_of_the_formula(self) -> None:
        scene = sdfc.compile(SHELL).at(r=0.8)
        at = points(100_003)
        expected = shell_distance(at, 0.8)
        found = scene.distance(at)
        self.assertEqual((found.shape, found.dtype), ((100_003,), np.float64))
        np.testing.assert_allclose(found, expected, rtol=0, atol=1e-12)

    def test_any_shape_of_points_gives_the_shape_without_its_last_axis(self) -> None:
        scene = sdfc.compile("sphere(1)")
        self.assertEqual(float(scene.distance([3, 0, 0])), 2)
        self.assertEqual(scene.distance(np.zeros((0, 3))).shape, (0,))
        grid = np.zeros((4, 5, 3), dtype=np.float32)
        self.assertEqual(scene.distance(grid).shape, (4, 5))
        self.assertEqual(scene.gradient(grid).shape, (4, 5, 3))
        strided = np.arange(24.0).reshape(3, 8).T
        lengths = np.linalg.norm(strided, axis=-1)
        np.testing.assert_allclose(scene.distance(strided), lengths - 1, atol=1e-12)
        for wrong in (1.0, [1, 2], np.zeros((3, 4))):
            with self.assertRaisesRegex(sdfc.ArgumentError, r"the shape \(\.\.\., 3\)"):
                scene.distance(wrong)

    def test_gradients_are_the_slopes_of_distances(self) -> None:
        scene = sdfc.compile("union(sphere(0.6), box([1, 0.5, 2]), blend: smooth(0.2))")
        at = points(500)
        step = 1e-6 * np.eye(3)
        slopes = [scene.distance(at + axis) - scene.distance(at - axis) for axis in step]
        np.testing.assert_allclose(scene.gradient(at), np.stack(slopes, -1) / 2e-6, atol=1e-5)

    def test_threads_share_a_scene(self) -> None:
        scene = sdfc.compile("gyroid(0.3, 0.05) & sphere(2)")
        at = points(100_000)
        with ThreadPoolExecutor(4) as pool:
            first, *others = pool.map(lambda _: scene.distance(at), range(4))
        for other in others:
            np.testing.assert_array_equal(first, other)
        # This kind of library would keep the lock of the interpreter during calls.
        self.assertNotIsInstance(_native.lib, _native.ctypes.PyDLL)

    def test_bounds_are_corners(self) -> None:
        bounds = sdfc.compile(SHELL).bounds
        self.assertEqual(bounds.shape, (2, 3))
        np.testing.assert_allclose(bounds, [[-0.5] * 3, [0.5] * 3])
        self.assertEqual(sdfc.compile("plane(y: 0)").bounds[0, 0], -math.inf)


class Params(unittest.TestCase):
    SOURCE = """
    /// Radius of the ball.
    param r = 0.5 in 0.1..1
    param turn = 90deg in 0deg..360deg
    param n: int = 2 in 1..9
    param lid = true
    param tint = #ff0000
    let ball = sphere(if lid { r } else { 2 * r }).color(tint).rotate(y: turn)
    union([for i in 0..n: ball.translate(x: 4 * i)])
    """

    def test_params_are_described(self) -> None:
        params = sdfc.compile(self.SOURCE).params
        self.assertEqual(list(params), ["r", "turn", "n", "lid", "tint"])
        r = params["r"]
        self.assertEqual((r.type, r.value, r.min, r.max, r.fixed), ("number", 0.5, 0.1, 1, False))
        self.assertEqual(r.summary, "Radius of the ball.")
        self.assertAlmostEqual(params["turn"].value, math.pi / 2)
        self.assertEqual((params["n"].value, params["n"].fixed), (2, True))
        self.assertIs(params["lid"].value, True)
        self.assertEqual(params["tint"].value, (1, 0, 0, 1))

    def test_a_scene_with_other_values_leaves_the_first_one_unchanged(self) -> None:
        scene = sdfc.compile(self.SOURCE)
        other = scene.at({"tint": "#00ff00"}, r=np.float32(0.25), lid=False, turn="45deg")
        self.assertEqual(float(scene.distance([0, 2, 0])), 1.5)
        self.assertEqual(float(other.distance([0, 2, 0])), 1.5)
        self.assertEqual(float(other.at(lid=True).distance([0, 2, 0])), 1.75)
        self.assertEqual(other.params["tint"].value, (0, 1, 0, 1))
        self.assertAlmostEqual(other.at(turn=1).params["turn"].value, 1)

    def test_values_that_a_param_does_not_take_are_errors(self) -> None:
        scene = sdfc.compile(self.SOURCE)
        wrong = [
            {"q": 1},
            {"r": 7},
            {"r": "x"},
            {"r": math.nan},
            {"lid": 0.5},
            {"r": True},
            {"n": 3},
        ]
        for values in wrong:
            with self.subTest(values), self.assertRaises(sdfc.ArgumentError):
                scene.at(values)
        with self.assertRaisesRegex(ValueError, "has no param `q`; it has r, turn, n, lid, tint"):
            scene.at(q=1)

    def test_fixed_params_are_set_when_the_scene_is_compiled(self) -> None:
        scene = sdfc.compile(self.SOURCE, values={"n": 3, "r": 0.25, "turn": "10deg", "lid": True})
        self.assertEqual(float(scene.distance([8, 0, 0])), -0.25)
        with self.assertRaisesRegex(sdfc.ArgumentError, "takes 1..9; 10 is outside"):
            sdfc.compile(self.SOURCE, values={"n": 10})

    def test_time_and_frame_move_a_scene(self) -> None:
        scene = sdfc.compile("sphere(1).translate(x: time)")
        self.assertEqual(float(scene.at(time=3).distance([3, 0, 0])), -1)
        for wrong in ({"time": math.nan}, {"time": math.inf}, {"frame": 0.5}):
            with self.subTest(wrong), self.assertRaisesRegex(sdfc.ArgumentError, "must be finite"):
                scene.at(**wrong)


class Errors(unittest.TestCase):
    def test_an_error_of_the_source_has_place_code_and_help(self) -> None:
        with self.assertRaises(sdfc.CompileError) as caught:
            sdfc.compile("sphere(1)\nspere(1)", name="ball.sdf")
        text = str(caught.exception)
        for part in ("error[E0201]", "ball.sdf:2:1", "did you mean `sphere`?"):
            self.assertIn(part, text)
        (row,) = caught.exception.diagnostics
        self.assertEqual((row.code, row.line, row.column, row.end_column), ("E0201", 2, 1, 6))
        self.assertEqual(row.fixes[0]["edits"][0]["text"], "sphere")
        self.assertEqual(str(row), "ball.sdf:2:1: error[E0201]: unknown name `spere`")

    def test_warnings_are_data(self) -> None:
        (warning,) = sdfc.compile(
            "let blob = union(sphere(1), box(1.5), blend: smooth(0.3))\nblob.round(0.2)"
        ).warnings
        self.assertEqual(warning.severity, "warning")

    def test_text_that_is_not_utf8_is_an_error(self) -> None:
        with self.assertRaisesRegex(sdfc.ArgumentError, "not UTF-8"):
            sdfc.compile("sphere(1) // \ud800")
        with self.assertRaisesRegex(sdfc.ArgumentError, "null character"):
            sdfc.compile("sphere(1)", name="a\0b")

    def test_imports_come_from_files(self) -> None:
        source = 'import ball from "parts/ball.sdf"\nball()'
        ball = "solid ball() = length(p) - 0.25"
        asked = []

        def read(path: str) -> str:
            asked.append(path)
            return ball

        for files in ({"parts/ball.sdf": ball}, {"parts/ball.sdf": ball.encode()}, read):
            self.assertEqual(float(sdfc.compile(source, files=files).distance([0, 0, 0])), -0.25)
        self.assertEqual(asked, ["parts/ball.sdf"])
        for files in (None, {}):
            with self.assertRaisesRegex(sdfc.CompileError, "E0209"):
                sdfc.compile(source, files=files)
        with self.assertRaises(ZeroDivisionError):
            sdfc.compile(source, files=lambda path: path * (1 // 0))
        with tempfile.TemporaryDirectory() as folder:
            (Path(folder) / "parts").mkdir()
            (Path(folder) / "parts/ball.sdf").write_text(ball)
            (Path(folder) / "scene.sdf").write_text(source)
            scene = sdfc.load(Path(folder) / "scene.sdf")
            self.assertEqual(float(scene.distance([0, 0, 0])), -0.25)
            (Path(folder) / "other").mkdir()
            (Path(folder) / "other/scene.sdf").write_text(source)
            with self.assertRaises(sdfc.CompileError):
                sdfc.load(Path(folder) / "other/scene.sdf")
            with unittest.mock.patch.dict(os.environ, {"SDFC_PATH": folder}):
                sdfc.load(Path(folder) / "other/scene.sdf")
            (Path(folder) / "outside.sdf").write_text('import ball from "../b.sdf"\nball()')
            with self.assertRaises(sdfc.CompileError):
                sdfc.load(Path(folder) / "outside.sdf")
            with self.assertRaises(FileNotFoundError):
                sdfc.load(Path(folder) / "none.sdf")

    def test_a_clause_that_is_wrong_is_an_error(self) -> None:
        with self.assertRaisesRegex(sdfc.CompileError, "E0502"):
            sdfc.compile("solid egg() exact = length(p*[1,0.7,1])-1\negg()")

    def test_a_file_is_read_as_the_command_line_reads_it(self) -> None:
        with tempfile.TemporaryDirectory() as folder:
            path = Path(folder) / "scene.sdf"
            path.write_bytes(b"sphere(1) // \xff")
            with self.assertRaisesRegex(sdfc.ArgumentError, "not UTF-8"):
                sdfc.load(path)
            path.write_bytes(b"sphere(1)\r\nspere(1)")
            with self.assertRaisesRegex(sdfc.CompileError, "scene.sdf:2:1"):
                sdfc.load(path)
            with path.open("wb") as file:
                file.truncate((64 << 20) + 1)
            with self.assertRaisesRegex(OSError, "larger than 64 MiB"):
                sdfc.load(path)

    @unittest.skipIf(os.name == "nt", "links need rights")
    def test_links_out_of_the_folder_are_not_followed(self) -> None:
        source = 'import ball from "ball.sdf"\nball()'
        ball = "solid ball() = length(p) - 0.25"
        with tempfile.TemporaryDirectory() as outer:
            folder = Path(outer) / "scenes"
            folder.mkdir()
            (folder / "scene.sdf").write_text(source)
            (Path(outer) / "ball.sdf").write_text(ball)
            (folder / "ball.sdf").symlink_to("../ball.sdf")
            with self.assertRaisesRegex(sdfc.CompileError, "E0209"):
                sdfc.load(folder / "scene.sdf")
            (folder / "ball.sdf").unlink()
            (folder / "inside.sdf").write_text(ball)
            (folder / "ball.sdf").symlink_to("inside.sdf")
            # Also if the path to the folder has a link.
            (Path(outer) / "other").symlink_to("scenes")
            scene = sdfc.load(Path(outer) / "other/scene.sdf")
            self.assertEqual(float(scene.distance([0, 0, 0])), -0.25)


class Meshes(unittest.TestCase):
    def test_a_mesh_is_closed_and_on_the_surface(self) -> None:
        mesh = sdfc.compile(SHELL).mesh(error=0.01)
        self.assertTrue(mesh.certificate["is_proven"])
        self.assertEqual((mesh.vertices.dtype, mesh.triangles.dtype), (np.float64, np.uint32))
        self.assertEqual(mesh.vertices.shape, mesh.normals.shape)
        self.assertEqual(mesh.colors.shape, mesh.vertices.shape)
        self.assertLess(np.abs(shell_distance(mesh.vertices, 0.5)).max(), 0.01)
        edges = mesh.triangles[:, [0, 1, 1, 2, 2, 0]].reshape(-1, 2)
        ways = {tuple(edge) for edge in edges.tolist()}
        self.assertEqual(len(ways), len(edges))
        self.assertTrue(all((b, a) in ways for a, b in ways))
        a, b, c = (mesh.vertices[mesh.triangles[:, i]] for i in range(3))
        self.assertAlmostEqual(np.einsum("ij,ij", a, np.cross(b, c)) / 6, mesh.volume)
        self.assertIsNone(sdfc.compile("sphere(1)").mesh(relative=0.1).colors)

    def test_an_error_greater_than_all_parts_is_refused(self) -> None:
        balls = sdfc.compile("sphere(0.01) | sphere(0.01).translate(x: 10)")
        with self.assertRaisesRegex(sdfc.ArgumentError, "state a smaller error"):
            balls.mesh(error=9)

    def test_arrays_are_read_only(self) -> None:
        mesh = sdfc.compile("sphere(1)").mesh(error=0.1)
        for array in (mesh.vertices, mesh.triangles):
            with self.assertRaisesRegex(ValueError, "read-only"):
                array[:] = 0

    def test_arrays_keep_their_memory(self) -> None:
        vertices = sdfc.compile("sphere(1)").mesh(error=0.01).vertices
        gc.collect()
        for _ in range(20):
            sdfc.compile("sphere(1)").mesh(error=0.05)
        self.assertLess(np.abs(np.linalg.norm(vertices, axis=1) - 1).max(), 0.01)
        with self.assertRaises(ValueError):
            vertices[0] = 0

    def test_files_have_the_format_of_their_extension(self) -> None:
        mesh = sdfc.compile("sphere(1)").mesh(error=0.1)
        with tempfile.TemporaryDirectory() as folder:
            for name, start in {"a.stl": b"", "a.PLY": b"ply", "a.glb": b"glTF"}.items():
                path = Path(folder) / name
                mesh.save(path)
                self.assertTrue(path.read_bytes().startswith(start))
            size = (Path(folder) / "a.stl").stat().st_size
            self.assertEqual(size, 84 + 50 * len(mesh.triangles))
            with self.assertRaisesRegex(sdfc.ArgumentError, ".stl, .obj, .ply, .glb or .3mf"):
                mesh.save(Path(folder) / "a.docx")
            for extension in ("noext", "a.docx"):
                with self.assertRaisesRegex(sdfc.ArgumentError, f"{extension}: meshes are"):
                    mesh.save(Path(folder) / extension)

    def test_what_has_no_mesh_is_an_error(self) -> None:
        with self.assertRaisesRegex(sdfc.Error, "no limit along x"):
            sdfc.compile("plane(y: 0)").mesh()
        with self.assertRaisesRegex(sdfc.ArgumentError, "longest side is 2: state at most 2"):
            sdfc.compile("sphere(1)").mesh(1e300)
        for arguments in ({"error": -1}, {"error": math.nan}, {"error": 1, "relative": 1}):
            with self.subTest(arguments), self.assertRaises(sdfc.ArgumentError):
                sdfc.compile("sphere(1)").mesh(**arguments)

    def test_an_exception_of_progress_stops_the_work(self) -> None:
        seen = []

        def progress(done: int, total: int) -> None:
            seen.append((done, total))
            if len(seen) == 3:
                raise RuntimeError("enough")

        with self.assertRaisesRegex(RuntimeError, "enough"):
            sdfc.compile("sphere(1)").mesh(error=1e-4, progress=progress)
        self.assertEqual(len(seen), 3)

    @unittest.skipUnless(hasattr(signal, "setitimer"), "no timers")
    def test_a_signal_stops_the_work(self) -> None:
        def interrupt(*_: object) -> None:
            raise KeyboardInterrupt

        before = signal.signal(signal.SIGALRM, interrupt)
        try:
            signal.setitimer(signal.ITIMER_REAL, 0.3)
            with self.assertRaises(KeyboardInterrupt):
                sdfc.compile("gyroid(0.1, 0.02) & sphere(2)").mesh(error=1e-5)
        finally:
            signal.setitimer(signal.ITIMER_REAL, 0)
            signal.signal(signal.SIGALRM, before)

    def test_a_contour_has_its_holes(self) -> None:
        contour = sdfc.compile("sphere(1) - sphere(0.5)").contour(error=1e-3)
        outer, hole = sorted(contour.paths, key=lambda path: path.is_hole)
        self.assertEqual((outer.is_hole, hole.is_hole), (False, True))
        np.testing.assert_allclose(np.linalg.norm(hole.points, axis=1), 0.5, atol=1e-3)
        self.assertAlmostEqual(contour.area, math.pi * 0.75, delta=0.01)
        self.assertFalse(outer.bulges.any())
        arcs = sdfc.compile("sphere(1)").contour(error=1e-3, arcs=True).paths[0]
        self.assertTrue((arcs.bulges > 0.3).all() and len(arcs.points) < 8)
        with tempfile.TemporaryDirectory() as folder:
            contour.save(Path(folder) / "a.svg")
            self.assertIn("<svg", (Path(folder) / "a.svg").read_text())
        with self.assertRaisesRegex(sdfc.ArgumentError, "meets no inside"):
            sdfc.compile("sphere(1)").contour([1, 0, 0], 2)
        with self.assertRaisesRegex(sdfc.ArgumentError, "noext: contours are"):
            contour.save(Path(folder) / "noext")
        with self.assertRaisesRegex(sdfc.ArgumentError, "plane z=0: state no other plane"):
            sdfc.compile("circle(1)").contour([1, 0, 0])

    def test_measurements_are_intervals_that_hold_the_truth(self) -> None:
        found = sdfc.compile("box([1, 2, 3]).translate(x: 5)").measure(0.01)
        low, high = found.volume
        self.assertTrue(low <= 6 <= high < 1.02 * low)
        self.assertTrue((found.center_of_mass[:, 0] <= [5, 0, 0]).all())
        self.assertTrue((found.center_of_mass[:, 1] >= [5, 0, 0]).all())
        self.assertEqual(found.inertia.shape, (6, 2))


class Pictures(unittest.TestCase):
    def test_a_picture_is_an_array(self) -> None:
        scene = sdfc.compile(SHELL)
        picture = scene.render((48, 30), backend="cpu")
        self.assertEqual((picture.pixels.shape, picture.pixels.dtype), ((30, 48, 4), np.uint8))
        self.assertTrue((picture.pixels[..., 3] == 255).all())
        red, green, _, _ = picture.pixels[15, 24].tolist()
        self.assertGreater(red, 2 * green)
        self.assertTrue(np.isinf(picture.depths[0, 0]) and np.isfinite(picture.depths[15, 24]))
        self.assertTrue((np.asarray(picture) == picture.pixels).all())
        part = scene.render((48, 30), backend="cpu", region=(8, 4, 20, 10))
        np.testing.assert_array_equal(part.pixels, picture.pixels[4:14, 8:28])

    def test_a_notebook_and_a_file_get_a_png(self) -> None:
        scene = sdfc.compile(SHELL)
        picture = scene.render((48, 30), backend="cpu")
        self.assertTrue(picture._repr_png_().startswith(b"\x89PNG"))
        with tempfile.TemporaryDirectory() as folder:
            picture.save(Path(folder) / "a.png")
            self.assertEqual((Path(folder) / "a.png").read_bytes(), picture.png())
            with self.assertRaisesRegex(sdfc.ArgumentError, "as .png"):
                picture.save(Path(folder) / "a.jpg")

    def test_the_gpu_draws_the_picture_of_the_cpu(self) -> None:
        scene = sdfc.compile(SHELL)
        try:
            gpu = scene.render((96, 60), backend="gpu").pixels.astype(int)
        except sdfc.MachineError as error:
            self.skipTest(str(error))
        cpu = scene.render((96, 60), backend="cpu").pixels.astype(int)
        differs = (np.abs(gpu - cpu) > 1).any(axis=-1)
        self.assertLess(differs.mean(), 0.005)

    def test_a_camera_is_where_it_is_said_to_be(self) -> None:
        scene = sdfc.compile("sphere(1)")
        camera = {"eye": np.array([0, 0, 5]), "target": [0, 0, 0], "fov": math.radians(30)}
        picture = scene.render((31, 31), backend="cpu", camera=camera)
        self.assertAlmostEqual(float(picture.depths[15, 15]), 4, places=2)
        with self.assertRaisesRegex(sdfc.ArgumentError, "40 radians"):
            scene.render(backend="cpu", camera={"eye": [0, 0, 5], "fov": 40})
        with self.assertRaisesRegex(sdfc.ArgumentError, "unknown field `zoom`"):
            scene.render(camera={"eye": [0, 0, 5], "zoom": 2})


class Shaders(unittest.TestCase):
    def test_a_scene_is_a_shader(self) -> None:
        scene = sdfc.compile(SHELL).at(r=0.75)
        self.assertIn("fn sdf_distance(", scene.wgsl())
        shader = scene.shader("glsl", prefix="a_")
        self.assertIn("float a_distance(", shader.code)
        self.assertEqual(np.frombuffer(shader.uniform[:4], "<f4")[0], 0.75)
        self.assertEqual(shader.reflection["params"][0]["param"], "r")
        words = np.frombuffer(scene.shader("spirv").code, "<u4")
        self.assertEqual(words[0], 0x07230203)
        self.assertEqual(sdfc.compile("sphere(1)").shader().uniform, b"")
        with self.assertRaisesRegex(sdfc.ArgumentError, "unknown target `cobol`; the targets are"):
            scene.shader("cobol")
        for wrong in (-1, 65_536, 2**32 + 5):
            with self.assertRaisesRegex(sdfc.ArgumentError, "65535"):
                scene.shader(binding=wrong)
            with self.assertRaisesRegex(sdfc.ArgumentError, "65535"):
                scene.shader(group=wrong)
        with self.assertRaisesRegex(sdfc.ArgumentError, "and the ray method needs solids"):
            sdfc.compile("circle(1)").shader(part="march")


class Documents(unittest.TestCase):
    def test_the_programs_of_the_pages_run(self) -> None:
        for page in PAGES:
            (program,) = re.findall(
                r"^```python\n(.*?)^```", page.read_text(), re.DOTALL | re.MULTILINE
            )
            with tempfile.TemporaryDirectory() as folder, self.subTest(page.name):
                before = os.getcwd()
                os.chdir(folder)
                try:
                    exec(program, {})
                finally:
                    os.chdir(before)
                self.assertTrue(list(Path(folder).glob("*.stl")))


if __name__ == "__main__":
    unittest.main()
