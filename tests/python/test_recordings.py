"""Recordings open elsewhere: programs of others read every format, and find places, colours, faces and times as we tell
them.

Ours is the `.jsonl` of a line a record, which the standard library reads. POINTMASS is the program.
"""

import json
import os
import subprocess
import tempfile
import unittest
from pathlib import Path

import meshio
import numpy as np
import pandas as pd
import pyvista
import trimesh
from ovito.io import import_file

PROGRAM = os.environ["POINTMASS"]
ENDS = ["csv", "xyz", "npz", "npy", "ply", "obj", "vtp", "glb", "gltf"]
GRAVITY = [{"gravity": {"acceleration": [0, -9.8, 0]}}]

SCENES = {
    # Nobody is there at first; births and deaths, colours that fade, a column of a user's own.
    "fountain": {
        "run": {"dt": 0.05, "capacity": 500, "seed": 3},
        "forces": GRAVITY,
        "custom": [{"name": "heat", "newborn": 36.6}],
        "emitters": [{
            "shape": {"sphere": {"center": [0, 1, 0], "radius": 0.5}}, "rate": 200, "start": 0.1, "speed": 2,
            "radius": {"mean": 0.02, "half_width": 0.01}, "charge": {"mean": 0, "half_width": 1},
            "color": [200, 100, 50, 255], "color_half_width": [50, 50, 50, 0],
            "lifetime": {"mean": 0.4, "half_width": 0.2},
        }],
    },
    # A sheet among free particles.
    "cloth": {
        "run": {"dt": 0.01},
        "forces": GRAVITY,
        "particles": [{"position": [0, 3, 0], "color": [255, 0, 10, 128]}, {"position": [1, 3, 0.1]}],
        "cloths": [{
            "form": {"sheet": {"corner": [0, 1, 0], "sides": [[1, 0, 0], [0, 0, 1]], "cells": [5, 4]}},
            "mass": 1, "fixed": [0, 5], "color": [10, 200, 90, 255],
            "springs": {"structural": {"ks": 50, "kd": 0.1}, "shear": {"ks": 5}},
        }],
    },
    # Springs alone.
    "rope": {
        "run": {"dt": 0.01},
        "forces": GRAVITY,
        "particles": [{"position": [i * 0.1, 1, 0], "fixed": i == 0, "color": [20 * i, 7, 9, 255]} for i in range(10)],
        "springs": [{"ends": [i, i + 1], "rest_length": 0.1, "ks": 100, "kd": 0.1} for i in range(9)],
    },
}


class Recording:
    """A scene's recording in every format, and what we say of it."""

    def __init__(self, name):
        self.keep = tempfile.TemporaryDirectory()
        self.folder = Path(self.keep.name)
        (self.folder / "a.json").write_text(json.dumps(SCENES[name]))
        outs = [part for end in ENDS for part in ("--out", f"a.{end}")]
        for args in [outs, ["--line", "record", "--out", "a.jsonl"], ["--out", "rows.jsonl"]]:
            command = [PROGRAM, "run", "a.json", "--steps", "10", "--every", "5", *args]
            subprocess.run(command, cwd=self.folder, check=True, stdout=subprocess.DEVNULL)
        self.frames = [Frame(json.loads(line)) for line in (self.folder / "a.jsonl").read_text().splitlines()]

    def path(self, name):
        return str(self.folder / name)

    def numbered(self, end):
        """The frames with their files, of a format that has one a record."""
        return [(frame, self.path(f"a_{i:06}.{end}")) for i, frame in enumerate(self.frames)]


class Frame:
    """A record as we tell it."""

    def __init__(self, told):
        self.step, self.time = told.pop("step"), told.pop("time")
        self.faces = np.array(told.pop("faces", []), dtype=int).reshape(-1, 3)
        self.edges = np.array(told.pop("edges", []), dtype=int).reshape(-1, 2)
        self.columns = told

    def of(self, *names, kind=np.float32):
        return np.array([self.columns[name] for name in names], dtype=kind).T

    @property
    def places(self):
        return self.of("x", "y", "z")

    @property
    def colors(self):
        return self.of("red", "green", "blue", "alpha", kind=np.uint8)


RECORDINGS = {}


def setUpModule():
    RECORDINGS.update({name: Recording(name) for name in SCENES})


def tearDownModule():
    for recording in RECORDINGS.values():
        recording.keep.cleanup()


def light(colors):
    """Colours as the light that glTF has, in parts of 255."""
    share = colors / 255
    linear = np.where(share <= 0.04045, share / 12.92, ((share + 0.055) / 1.055) ** 2.4)
    linear[:, 3] = share[:, 3]
    return linear * 255


class Elsewhere(unittest.TestCase):
    """What each of them reads is what we tell, to the bit but where the program rounds."""

    def equal(self, read, told):
        np.testing.assert_array_equal(np.asarray(read), told)

    def near(self, read, told, within):
        np.testing.assert_allclose(np.asarray(read, dtype=float), told, rtol=0, atol=within)

    def test_numpy(self):
        for recording in RECORDINGS.values():
            arrays = np.load(recording.path("a.npz"))
            self.equal(arrays["steps"], [frame.step for frame in recording.frames])
            self.equal(arrays["times"], [frame.time for frame in recording.frames])
            for i, frame in enumerate(recording.frames):
                self.assertEqual(np.load(recording.path(f"a_{i:06}_time.npy")), frame.time)
                for name, told in frame.columns.items():
                    array = arrays[f"{frame.step}/{name}"]
                    self.equal(array, np.array(told, dtype=array.dtype))
                    self.equal(np.load(recording.path(f"a_{i:06}_{name}.npy")), array)
                if len(frame.faces):
                    self.equal(arrays[f"{frame.step}/faces"], frame.faces)
                if len(frame.edges):
                    self.equal(arrays[f"{frame.step}/edges"], frame.edges)

    def test_pandas(self):
        for recording in RECORDINGS.values():
            for table in pd.read_csv(recording.path("a.csv")), pd.read_json(recording.path("rows.jsonl"), lines=True):
                for frame in recording.frames:
                    rows = table[table.step == frame.step]
                    for name, told in frame.columns.items():
                        # Either may spell or parse the last digit of a double in its own way.
                        np.testing.assert_allclose(rows[name], told, rtol=1e-14, atol=0)

    def test_meshio(self):
        # It reads no edges in a PLY.
        for name in "fountain", "cloth":
            for frame, path in RECORDINGS[name].numbered("ply"):
                mesh = meshio.read(path)
                self.equal(mesh.points.reshape(-1, 3), frame.places)
                channels = [mesh.point_data[name] for name in ("red", "green", "blue", "alpha")]
                # It takes bytes for signed.
                self.equal(np.array(channels).T.astype(np.uint8), frame.colors)
                self.equal(mesh.cells_dict.get("triangle", np.empty((0, 3))), frame.faces)
        for frame, path in RECORDINGS["cloth"].numbered("obj"):
            mesh = meshio.read(path)
            self.equal(mesh.points[:, :3].astype(np.float32), frame.places)
            self.equal(mesh.cells_dict["triangle"], frame.faces)

    def test_pyvista(self):
        for recording in RECORDINGS.values():
            reader = pyvista.get_reader(recording.path("a.pvd"))
            self.assertEqual(reader.time_values, [frame.time for frame in recording.frames])
            for i, frame in enumerate(recording.frames):
                reader.set_active_time_point(i)
                [piece] = reader.read()
                self.equal(piece.points, frame.places)
                self.equal(piece.point_data["color"].reshape(-1, 4), frame.colors)
                self.equal(piece.point_data["velocity"].reshape(-1, 3), frame.of("vx", "vy", "vz"))
                self.assertEqual(piece.field_data["TimeValue"], frame.time)
                for name in frame.columns.keys() - {*"xyz", "vx", "vy", "vz", "red", "green", "blue", "alpha"}:
                    array = piece.point_data[name]
                    self.equal(array, np.array(frame.columns[name], dtype=array.dtype))
                self.faces(piece, frame)
                self.equal(piece.lines.reshape(-1, 3)[:, 1:], frame.edges)
            for frame, path in recording.numbered("ply"):
                mesh = pyvista.read(path)
                self.equal(mesh.points, frame.places)
                if len(frame.places):
                    self.equal(mesh.point_data["RGBA"], frame.colors)
                self.faces(mesh, frame)

    def faces(self, mesh, frame):
        if len(frame.faces):
            self.equal(mesh.regular_faces, frame.faces)

    def test_trimesh(self):
        for recording in RECORDINGS.values():
            for frame, path in recording.numbered("ply") + RECORDINGS["cloth"].numbered("obj"):
                # It merges corners unless it is told not to.
                mesh = trimesh.load(path, process=False)
                if not len(frame.places):
                    continue
                if not len(frame.faces):
                    self.equal(mesh.vertices, frame.places)
                    # It takes edges for a path, which has no colours.
                    self.equal(mesh.colors, None if len(frame.edges) else frame.colors)
                    continue
                # Of an OBJ it drops the vertices that are in no face.
                self.equal(np.float32(mesh.vertices)[mesh.faces], frame.places[frame.faces])
                self.equal(mesh.visual.vertex_colors[mesh.faces][..., :3], frame.colors[frame.faces][..., :3])
            for end in "glb", "gltf":
                scene = trimesh.load(recording.path(f"a.{end}"), process=False)
                for frame in recording.frames:
                    self.gltf(scene, frame)

    def gltf(self, scene, frame):
        """The parts of a record in a glTF; each has all of its vertices."""
        parts = [part for name, part in scene.geometry.items() if name.split("_")[0] == str(frame.step)]
        self.assertEqual(bool(parts), bool(len(frame.places)))
        faces = [part.faces for part in parts if isinstance(part, trimesh.Trimesh)]
        if len(frame.faces):
            self.equal(faces[0], frame.faces)
        for part in parts:
            if isinstance(part, trimesh.path.Path3D):
                self.near(np.unique(part.vertices, axis=0), np.unique(frame.places, axis=0), 1e-7)
                continue
            rows = slice(None) if len(part.vertices) == len(frame.places) else self.singletons(frame)
            self.near(part.vertices, frame.places[rows], 0)
            is_mesh = isinstance(part, trimesh.Trimesh)
            colors = part.visual.vertex_attributes["color"] * 255 if is_mesh else part.colors
            self.near(colors, light(frame.colors)[rows], 1e-4 if is_mesh else 1)

    def singletons(self, frame):
        joined = np.concatenate([frame.faces.ravel(), frame.edges.ravel()])
        return np.setdiff1d(np.arange(len(frame.places)), joined)

    def test_ovito(self):
        # It has no reader of PLY, whoever wrote it, nor of VTK's files but those of one other program.
        for recording in RECORDINGS.values():
            pipeline = import_file(recording.path("a.xyz"))
            self.assertEqual(pipeline.num_frames, len(recording.frames))
            for i, frame in enumerate(recording.frames):
                data = pipeline.compute(i)
                self.assertAlmostEqual(data.attributes["Time"], frame.time)
                if not len(frame.places):
                    continue
                particles = data.particles
                self.equal(np.float32(particles.positions), frame.places)
                self.equal(np.float32(particles.velocities), frame.of("vx", "vy", "vz"))
                self.equal(particles.identifiers, frame.columns["id"])
                self.near(particles.colors[...] * 255, frame.colors[:, :3], 1e-4)
                for ours, theirs in ("radius", "Radius"), ("charge", "Charge"), ("mass", "Mass"), ("heat", "heat"):
                    if ours in frame.columns:
                        # Its parser may be off by the last bit.
                        np.testing.assert_allclose(particles[theirs], frame.columns[ours], rtol=2e-7)
        for frame, path in RECORDINGS["cloth"].numbered("obj"):
            [mesh] = self.meshes(path)
            self.assertEqual((mesh.vertex_count, mesh.face_count), (len(frame.places), len(frame.faces)))
            self.equal(np.float32(mesh.get_vertices()), frame.places)
            self.equal(mesh.get_faces(), frame.faces)

    def test_ovito_has_rooms(self):
        with tempfile.TemporaryDirectory() as folder:
            for sides, pbc in ([4, 5, 6], (True, True, True)), ([4, 0, 6], (True, False, True)):
                particles = [{"position": [-0.5, y, 2]} for y in (-3, 0, 7)]
                scene = {"room": {"low": [-1, -2, 0], "sides": sides}, "particles": particles}
                (Path(folder) / "a.json").write_text(json.dumps(scene))
                command = [PROGRAM, "run", "a.json", "--steps", "1", "--out", "a.xyz"]
                subprocess.run(command, cwd=folder, check=True, stdout=subprocess.DEVNULL)
                cell = import_file(str(Path(folder) / "a.xyz")).compute().cell
                self.assertEqual(tuple(cell.pbc), pbc)
                corner, wide = (-2, 5) if sides[1] else (-3, 10)
                self.equal(cell[...], [[4, 0, 0, -1], [0, wide, 0, corner], [0, 0, 6, 0]])

    def meshes(self, path):
        return [found for found in import_file(path).compute().objects if type(found).__name__ == "TriangleMesh"]


if __name__ == "__main__":
    unittest.main()
