# %% [markdown]
# A bowl from source to distances, a mesh and a picture. The cells run in a notebook, and this file
# is also a program: `python notebook.py`. Files are written to the current folder.

# %%
import time
from pathlib import Path

import numpy as np

import sdfc

scene = sdfc.load(Path(__file__).parent / "../bowl.sdf" if "__file__" in globals() else "bowl.sdf")
print(scene)

# %% [markdown]
# Distances at a million points, in the box around the scene.

# %%
low, high = scene.bounds
points = np.random.default_rng(0).uniform(low, high, (1_000_000, 3))
start = time.perf_counter()
distances = scene.distance(points)
print(f"{len(points)} distances in {time.perf_counter() - start:.2f} s")

# %% [markdown]
# The fraction of the points that lie inside estimates the volume; `measure` proves it.

# %%
estimate = (distances < 0).mean() * np.prod(high - low)
print(f"volume: about {estimate:.4f}, proven {scene.measure(0.01).volume}")

# %% [markdown]
# A mesh for a printer, within a hundredth of a scene unit.

# %%
mesh = scene.mesh(error=0.01)
mesh.save("bowl.stl")
print(mesh)

# %% [markdown]
# A picture with thinner walls. A notebook shows the value of the last line.

# %%
picture = scene.at(wall=0.05).render((640, 400), samples=4)
picture.save("bowl.png")
print(picture.note or "drawn on the GPU", picture.pixels.shape)
picture
