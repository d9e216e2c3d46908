#!/usr/bin/env python3
"""Checks meshes and contours of hard scenes with programs that sdfc does not share code with.

Run it by hand; CI does not. It needs ADMesh (Debian: admesh) and these Python packages:

    pip install trimesh networkx scipy lxml manifold3d pymeshlab ezdxf
    python3 tests/outside_tools/check_meshes.py target/debug/sdfc

It prints a row for each scene, and ends with 1 if a mesh has a defect.
"""

import json
import subprocess
import sys
import tempfile
from pathlib import Path

import ezdxf
import manifold3d
import numpy as np
import pymeshlab
import trimesh

# The error of each mesh, as a fraction of the longest side of the scene's bounds.
ERROR = "0.01"

# Name, scene, and the numbers of parts, cavities and holes: None where the exact answer depends on
# what is smaller than the error.
CASES = [
    ("ball", "sphere(1)", (1, 0, 0)),
    ("ring", "torus(1, 0.3)", (1, 0, 1)),
    ("thin wall", "box([1, 1, 0.004])", (1, 0, 0)),
    ("thin shell", "sphere(1) - sphere(0.99)", (1, 1, 0)),
    ("nested shells", "(sphere(1) - sphere(0.9)) | (sphere(0.8) - sphere(0.7))", (2, 2, 0)),
    ("cone", "cone(0.5, 1)", (1, 0, 0)),
    ("sharp cone", "cone(0.1, 2)", (1, 0, 0)),
    ("tangent balls", "sphere(1) | sphere(1).translate(x: 2)", None),
    ("coplanar faces", "box([1, 1, 1]) | box([1, 1, 1]).translate(x: 0.7)", (1, 0, 0)),
    ("faces that touch", "box([1, 1, 1]) | box([2, 0.2, 2]).translate(y: -0.6)", (1, 0, 0)),
    ("flush cut", "box([1, 1, 1]) - box([0.4, 1, 0.4])", (1, 0, 1)),
    ("ball in its hollow", "(box([2, 2, 2]) - sphere(0.7)) | sphere(0.7)", None),
    (
        "barely closed gap",
        "union(sphere(1), sphere(1).translate(x: 2.05), blend: smooth(0.3))",
        (1, 0, 0),
    ),
    ("twisted bar", "box([0.4, 0.4, 1.6]).twist(rate: 60deg)", (1, 0, 0)),
    ("acute edge", "box(2) & box([4, 1, 4]).rotate(y: 30deg).rotate(x: 25deg)", (1, 0, 0)),
    (
        "far from the origin",
        "(box([1, 1, 1]) - sphere(0.6)).translate([1e6, 1e6, 1e6])",
        (1, 0, 5),
    ),
    (
        "frame of bars",
        "box(2) - box([1.6, 1.6, 3]) - box([1.6, 3, 1.6]) - box([3, 1.6, 1.6])",
        (1, 0, 5),
    ),
    ("sheets far apart", "sphere(0.5)\nsphere(0.5).translate(x: 20)", (2, 0, 0)),
    ("spike on a ball", "sphere(1) | cone(0.08, 1).translate(y: 1.3)", None),
    ("chamfers", "box([1, 0.8, 0.6]).round(0.1) & sphere(0.62)", None),
]

# Examples of the repository.
FILES = ["pawn", "gear", "gyroid_lattice", "menger_sponge", "lettering", "polyhedra"]


def run(sdfc, *args):
    """Returns the standard error of sdfc."""
    done = subprocess.run([sdfc, *args], capture_output=True, text=True, check=False)
    if done.returncode:
        raise RuntimeError(done.stderr.strip())
    return done.stderr


def by_trimesh(path):
    """Returns parts, cavities and holes, and defects."""
    mesh = trimesh.load_mesh(path, process=False)
    defects = []
    if not mesh.is_watertight:
        defects.append("trimesh: open")
    if not mesh.is_winding_consistent:
        defects.append("trimesh: orientation")
    if mesh.volume <= 0:
        defects.append("trimesh: no volume")
    parts = mesh.split(only_watertight=False)
    cavities = sum(part.volume < 0 for part in parts)
    holes = sum((2 - part.euler_number) // 2 for part in parts)
    return (len(parts) - cavities, cavities, holes), defects


def by_manifold(path):
    """Returns a defect if Manifold does not take the mesh."""
    mesh = trimesh.load_mesh(path, process=False)
    positions = np.asarray(mesh.vertices, np.float64)
    taken = manifold3d.Manifold(manifold3d.Mesh64(positions, np.asarray(mesh.faces, np.uint64)))
    status = taken.status()
    return [] if status == manifold3d.Error.NoError else [f"manifold3d: {status}"]


def by_meshlab(path):
    """Returns defects of edges and vertices, and crossing triangles."""
    meshes = pymeshlab.MeshSet()
    meshes.load_new_mesh(str(path))
    found = meshes.get_topological_measures()
    names = ["boundary_edges", "non_two_manifold_edges", "non_two_manifold_vertices"]
    defects = [f"MeshLab: {found[name]} {name}" for name in names if found.get(name, 0)]
    meshes.compute_selection_by_self_intersections_per_face()
    crossing = meshes.current_mesh().selected_face_number()
    if crossing:
        defects.append(f"MeshLab: {crossing} crossing triangles")
    return defects


def by_admesh(path):
    """Returns the repairs that ADMesh wants to make to a binary STL file."""
    done = subprocess.run(["admesh", path], capture_output=True, text=True, check=True)
    repairs = ["Degenerate facets", "Edges fixed", "Facets removed", "Facets added"]
    repairs += ["Facets reversed", "Backwards edges", "Normals fixed"]
    defects = []
    for line in done.stdout.splitlines():
        for field in repairs:
            if line.strip().startswith(field) and int(line.split(":")[1].split()[0]):
                defects.append(f"ADMesh: {line.split('  ')[0].strip()}")
    return defects


def check_mesh(sdfc, scene, folder, expected):
    """Returns the numbers, the certificate and the defects."""
    files = {kind: folder / f"mesh.{kind}" for kind in ["stl", "ply", "obj", "3mf"]}
    report = folder / "mesh.json"
    for path in files.values():
        run(sdfc, "mesh", scene, "-o", path, "--error-relative", ERROR, "--json", report)
    found = json.loads(report.read_text())
    shells = found["shells"]
    cavities = sum(shell["is_cavity"] for shell in shells)
    holes = sum(shell["holes"] or 0 for shell in shells)
    own = (len(shells) - cavities, cavities, holes)
    counted, defects = by_trimesh(files["ply"])
    defects += by_manifold(files["ply"]) + by_meshlab(files["obj"]) + by_admesh(files["stl"])
    if any(shell["holes"] is None for shell in shells):
        defects.append("sdfc: a part is open")
    if counted != own:
        defects.append(f"trimesh counts {counted}, and sdfc {own}")
    if expected and own != expected:
        defects.append(f"{own} parts, cavities and holes instead of {expected}")
    package = trimesh.load(files["3mf"], force="mesh", process=False)
    if len(package.faces) != found["triangles"]:
        defects.append("trimesh: other triangles in the 3MF file")
    return found, own, defects


def check_contour(sdfc, folder):
    """Returns defects of a DXF file with arcs, whose section is known."""
    scene, path, report = folder / "plate.sdf", folder / "plate.dxf", folder / "plate.json"
    scene.write_text("box([1.6, 0.6, 0.6]).round(0.2) - cylinder(r: 0.25, h: 3).rotate(x: 90deg)\n")
    run(sdfc, "contour", scene, "-o", path, "--json", report)
    drawing = ezdxf.readfile(path)
    defects = [f"ezdxf: {error.message}" for error in drawing.audit().errors]
    error = json.loads(report.read_text())["certificate"]["error"]
    for line in drawing.modelspace():
        for part in line.virtual_entities():
            if part.dxftype() == "ARC":
                points = part.flattening(error / 100)
            else:
                points = [part.dxf.start, part.dxf.start.lerp(part.dxf.end)]
            for point in points:
                away = min(outline(point), abs(np.hypot(point.x, point.y) - 0.25))
                if away > 1.02 * error:
                    defects.append(f"ezdxf: a point is {away} from the section")
    return defects


def outline(point):
    """Returns the distance from a rectangle of 1.6 x 0.6 that is grown by 0.2."""
    x, y = abs(point.x) - 0.8, abs(point.y) - 0.3
    inside = min(max(x, y), 0)
    return abs(np.hypot(max(x, 0), max(y, 0)) + inside - 0.2)


def main():
    sdfc, examples = sys.argv[1], Path(__file__).parents[2] / "examples"
    is_good = True
    print("| scene | triangles | parts, cavities, holes | undecided boxes | defects |")
    print("|---|--:|---|--:|---|")
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        rows = [(title, folder / "scene.sdf", source, known) for title, source, known in CASES]
        rows += [(f"{title}.sdf", examples / f"{title}.sdf", None, None) for title in FILES]
        for title, scene, source, known in rows:
            if source:
                scene.write_text(source + "\n")
            try:
                found, own, defects = check_mesh(sdfc, scene, folder, known)
            except RuntimeError as error:
                print(f"| {title} | | | | {error} |", flush=True)
                is_good = False
                continue
            is_good = is_good and not defects
            undecided = found["certificate"]["undecided"]
            told = "; ".join(defects) or "none"
            print(f"| {title} | {found['triangles']} | {own} | {undecided} | {told} |", flush=True)
        defects = check_contour(sdfc, folder)
        is_good = is_good and not defects
        print(f"\nA contour with arcs, read by ezdxf: {'; '.join(defects) or 'no defects'}.")
    return 0 if is_good else 1


if __name__ == "__main__":
    sys.exit(main())
