"""Makes the height maps of this folder, each with a public tool of its format, and the reference that numpy gives.

    apt-get install gwyddion; pip install numpy pillow tifffile SurfaceTopography
    python3 make.py
"""

import ctypes
import glob
import json
import os

import numpy as np
import tifffile
from PIL import Image
from SurfaceTopography import Topography, read_topography

NX, NY = 30, 20
PIXEL = 0.5e-6
COUNT = 2e-9  # Height of a grey level.

# No symmetry, so that a mirrored or turned map is noticed; heights of about a micrometre, far from a mean of
# zero.
rng = np.random.default_rng(1)
y, x = np.mgrid[:NY, :NX]
z = 1e-6 * (5 + 0.8 * np.sin(0.35 * x + 0.1 * y) + 0.02 * x * (y / NY) ** 2 + 0.15 * rng.standard_normal((NY, NX)))
z -= 1.5e-6 * np.exp(-((x - 7) ** 2 + (y - 14) ** 2) / 9)
grey = np.round(z / COUNT).astype(np.uint16)
z = grey * COUNT  # The same heights in every format.

# SurfaceTopography counts along x, then along y from the top row, as it and Gwyddion show a surface; arrays
# of a case begin with the bottom row.
size = (NX * PIXEL, NY * PIXEL)
surface = Topography(z[::-1].T, size, unit="m")
rows = surface.heights().T[::-1]
assert np.array_equal(rows, z)
np.save("map.npy", rows)
np.save("map_f4_fortran.npy", np.asfortranarray((rows * 1e6).astype("<f4")))
np.savetxt("map.csv", rows * 1e6, fmt="%.4f", delimiter=";", header="heights in um")
# Pictures have the largest y at the top.
top = np.ascontiguousarray(grey[::-1])
Image.fromarray(top).save("map.png")
tifffile.imwrite("map.tif", top)
tifffile.imwrite("map_tiles.tif", (z[::-1] * 1e6).astype("f4"), tile=(16, 16), compression="zlib")
Image.fromarray(top).save("map_lzw.tif", compression="tiff_lzw")
# Refused: 8 bits, false colours, a palette.
level = np.round(255 * (top - top.min()) / np.ptp(top)).astype(np.uint8)
Image.fromarray(level).save("grey8.png")
Image.fromarray(np.dstack([level, 255 - level, level // 2])).save("colours.png")
tifffile.imwrite("colours.tif", np.dstack([top, top, top]))

for name, number in {"map": "D", "map_f4": "F", "map_i4": "L", "map_i2": "I"}.items():
    surface.to_x3p(f"{name}.x3p", dtype=number)


def gwyddion(source, target):
    """Gwyddion itself reads a file and writes it in another format."""
    load = lambda name: ctypes.CDLL(glob.glob(f"/usr/lib/*/lib{name}2.so.0")[0], mode=ctypes.RTLD_GLOBAL)
    names = ["gwyddion", "gwyprocess", "gwydraw", "gwydgets", "gwymodule", "gwyapp"]
    types, process, draw, _, modules, app = map(load, names)
    types.gwy_type_init(), process.gwy_process_type_init(), draw.gwy_draw_type_init()
    folder = glob.glob("/usr/lib/*/gwyddion/modules/file")[0]
    modules.gwy_module_register_modules((ctypes.c_char_p * 2)(folder.encode(), None))
    modules.gwy_file_load.restype = ctypes.c_void_p
    interactive = 1
    data = ctypes.c_void_p(modules.gwy_file_load(source.encode(), interactive, None))
    app.gwy_app_data_browser_add(data)
    app.gwy_app_data_browser_select_data_field(data, 0)
    modules.gwy_file_save(data, target.encode(), interactive, None)


surface.to_gwy("map.gwy")
gwyddion("map.gwy", "map.gsf")
os.remove("map.gwy")
# Both programs have the first row of an .x3p file on top.
gwyddion("map.x3p", "again.gsf")
heights_of = lambda name: np.fromfile(name, "<f4", offset=os.path.getsize(name) - 4 * NX * NY)
assert np.array_equal(heights_of("again.gsf"), heights_of("map.gsf"))
assert np.array_equal(read_topography("map.x3p").heights(), surface.heights())
os.remove("again.gsf")


def averages(nx, ny):
    """Means over nx x ny blocks: every point split so often that points and blocks are whole pieces."""
    fx, fy = np.lcm(NX, nx) // NX, np.lcm(NY, ny) // NY
    fine = np.kron(z, np.ones((fy, fx)))
    return fine.reshape(ny, fine.shape[0] // ny, nx, fine.shape[1] // nx).mean(axis=(1, 3))


d = z - z.mean()
sq = np.sqrt((d**2).mean())
reference = {
    "sa": np.abs(d).mean(),
    "sq": sq,
    "ssk": (d**3).mean() / sq**3,
    "sku": (d**4).mean() / sq**4,
    "blocks": {f"{nx}x{ny}": averages(nx, ny).ravel().tolist() for nx, ny in [(15, 10), (12, 8), (45, 30)]},
}
with open("reference.json", "w") as file:
    json.dump(reference, file, indent=1)
    file.write("\n")

# The ground surface of cases/ground.toml: scratches along x of random depth, place and length. It is made,
# not measured.
N, POINT = 80, 1.25e-6
ground = np.zeros((N, N))
y, x = np.mgrid[:N, :N] * POINT
for _ in range(600):
    x0, y0 = rng.uniform(-20e-6, 120e-6, 2)
    length, width = rng.uniform(20e-6, 60e-6), rng.uniform(1.5e-6, 4e-6)
    ground -= rng.exponential(0.15e-6) * np.exp(-(((x - x0) / length) ** 2) - ((y - y0) / width) ** 2)
ground += 0.02e-6 * rng.standard_normal((N, N))
Topography((ground - ground.mean()).T, (N * POINT, N * POINT), unit="m").to_gwy("ground.gwy")
gwyddion("ground.gwy", "../../../../cases/ground.gsf")
os.remove("ground.gwy")
