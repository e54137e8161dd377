#!/usr/bin/env python3
"""Writes the meshes beside it: flat squares of side 1 that are hard to compute on, folded starts, sharp obstacles."""

from math import cos, pi, sin
from pathlib import Path

HERE = Path(__file__).resolve().parent


def write(name, vertices, triangles):
    lines = ["OFF", f"{len(vertices)} {len(triangles)} 0"]
    lines += [" ".join(f"{c:.9g}" for c in (*v, 0)[:3]) for v in vertices]
    lines += ["3 " + " ".join(map(str, t)) for t in triangles]
    (HERE / f"{name}.off").write_text("\n".join(lines) + "\n")


def grid(n):
    vertices = [(i / (n - 1), j / (n - 1)) for j in range(n) for i in range(n)]
    quads = [(j * n + i, j * n + i + 1, (j + 1) * n + i + 1, (j + 1) * n + i) for j in range(n - 1) for i in range(n - 1)]
    return vertices, [t for a, b, c, d in quads for t in ((a, b, c), (a, c, d))]


def centre(vertices, t):
    return tuple(sum(vertices[v][k] for v in t) / 3 for k in (0, 1))


def valence_3(n=12):
    """A vertex in every third triangle."""
    vertices, triangles = grid(n)
    split = []
    for k, (a, b, c) in enumerate(triangles):
        if k % 3:
            split.append((a, b, c))
            continue
        m = len(vertices)
        vertices.append(centre(vertices, (a, b, c)))
        split += [(a, b, m), (b, c, m), (c, a, m)]
    write("valence_3", vertices, split)


def valence_20(spokes=20, rings=10):
    """A disc, its middle the hub of 20 spokes."""
    vertices = [(0.5, 0.5)]
    for r in range(1, rings + 1):
        vertices += [(0.5 + r / rings / 2 * cos(2 * pi * k / spokes), 0.5 + r / rings / 2 * sin(2 * pi * k / spokes)) for k in range(spokes)]
    triangles = []
    at = lambda r, k: 1 + (r - 1) * spokes + k % spokes
    for k in range(spokes):
        triangles.append((0, at(1, k), at(1, k + 1)))
        for r in range(1, rings):
            triangles += [(at(r, k), at(r + 1, k), at(r + 1, k + 1)), (at(r, k), at(r + 1, k + 1), at(r, k + 1))]
    write("valence_20", vertices, triangles)


def huge_and_tiny(n=17):
    """Two triangles as large as half the square, and a corner cut in triangles of a thousandth of that."""
    side = 0.03
    vertices, triangles = grid(n)
    vertices = [(1 - side + side * x, 1 - side + side * y) for x, y in vertices]
    corner = lambda i, j: j * n + i
    # A fan from the far corner to the patch's lower left border, and two from the others.
    a, b, c = len(vertices), len(vertices) + 1, len(vertices) + 2
    vertices += [(0, 0), (1, 0), (0, 1)]
    low, left = [corner(i, 0) for i in range(n)], [corner(0, j) for j in range(n)]
    triangles.append((a, b, low[0]))
    triangles += [(b, low[i + 1], low[i]) for i in range(n - 1)]
    triangles.append((a, left[0], c))
    triangles += [(c, left[j], left[j + 1]) for j in range(n - 1)]
    write("huge_and_tiny", vertices, triangles)


def faulty(n=9):
    vertices, triangles = grid(n)
    v = 3 * n + 3
    across = v - 1, v + n  # the other two of one of its triangles
    moved = list(vertices)
    moved[v] = (moved[v][0] + 0.3, moved[v][1])
    write("inverted", moved, triangles)
    moved[v] = tuple((vertices[across[0]][k] + vertices[across[1]][k]) / 2 for k in (0, 1))
    write("no_area", moved, triangles)


def needle(sides=8, height=0.15, radius=0.005):
    """A cone with its point at the origin."""
    ring = [(radius * cos(2 * pi * k / sides), radius * sin(2 * pi * k / sides), -height) for k in range(sides)]
    sheath = [(0, k + 1, (k + 1) % sides + 1) for k in range(sides)]
    write("needle", [(0, 0, 0)] + ring, sheath + [(1, k + 1, k) for k in range(2, sides)])


def layers(n=10, columns=31, rows=6, length=0.5, width=0.08, gap=0.004):
    """A strip, flat, and folded to and fro in n layers: the same triangles."""
    vertices, triangles = grid(2)
    at = lambda i, j: j * columns + i
    triangles = []
    for j in range(rows - 1):
        for i in range(columns - 1):
            triangles += [(at(i, j), at(i + 1, j), at(i + 1, j + 1)), (at(i, j), at(i + 1, j + 1), at(i, j + 1))]
    flat = [(length * i / (columns - 1), width * j / (rows - 1)) for j in range(rows) for i in range(columns)]
    write("strip", flat, triangles)
    leaf = length / n
    run = (leaf**2 - gap**2) ** 0.5  # slanting, so that nothing is stretched
    per = (columns - 1) // n
    folded = []
    for j in range(rows):
        for i in range(columns):
            k, part = divmod(i, per)
            t = part / per
            x = run * (t if k % 2 == 0 else 1 - t)
            folded.append((x, width * j / (rows - 1), gap * (k + t)))
    write("strip_folded", folded, triangles)


def sleeve(around=24, along=13, radius=0.06, length=0.4):
    """A tube about the z axis, open at both ends."""
    at = lambda i, j: j * around + i % around
    vertices = [(radius * cos(2 * pi * i / around), radius * sin(2 * pi * i / around), length * j / (along - 1)) for j in range(along) for i in range(around)]
    triangles = []
    for j in range(along - 1):
        for i in range(around):
            triangles += [(at(i, j), at(i + 1, j), at(i + 1, j + 1)), (at(i, j), at(i + 1, j + 1), at(i, j + 1))]
    write("sleeve", vertices, triangles)


for make in (valence_3, valence_20, huge_and_tiny, faulty, needle, layers, sleeve):
    make()
