"""Prototypes that the tests and the benchmark share."""

import numpy
import scipy.sparse
import scipy.sparse.linalg

import drape


def edges(x):
    """Two edges of triangles m×3×3, each 3×m."""
    corners = x.transpose(1, 2, 0)
    return corners[1] - corners[0], corners[2] - corners[0]


def dot(a, b):
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


class NumpyStvk(drape.Energy):
    """The St. Venant-Kirchhoff membrane, as plugins/energy/stvk, in numpy."""

    role = "membrane"
    midpoint_factor = 1.0

    def elements(self, level):
        return level.triangles

    def rest(self, level, material):
        """The inverse of the edges in the triangle's own plane, an upper triangle; volume; mu; lambda."""
        e1, e2 = edges(level.rest[level.triangles])
        length = numpy.sqrt(dot(e1, e1))
        along = dot(e1, e2) / length
        height = numpy.sqrt(dot(e2, e2) - along**2)
        inverse = 1 / length, -along / (length * height), 1 / height
        nu = material.poisson_ratio
        mu = material.mean_membrane_modulus / (2 * (1 + nu))
        lam = material.mean_membrane_modulus * nu / (1 - nu * nu)
        return inverse, material.thickness * length * height / 2, mu, lam

    def strain(self, x, rest):
        """The columns of F, and 11, 12, 22 of Green's strain and of the stress."""
        (i11, i12, i22), _, mu, lam = rest
        e1, e2 = edges(x)
        f1, f2 = i11 * e1, i12 * e1 + i22 * e2
        strain = (dot(f1, f1) - 1) / 2, dot(f1, f2) / 2, (dot(f2, f2) - 1) / 2
        pressure = lam * (strain[0] + strain[2])
        stress = 2 * mu * strain[0] + pressure, 2 * mu * strain[1], 2 * mu * strain[2] + pressure
        return f1, f2, strain, stress

    def value(self, x, rest):
        _, volume, _, _ = rest
        _, _, (e11, e12, e22), (s11, s12, s22) = self.strain(x, rest)
        return volume / 2 * (s11 * e11 + 2 * s12 * e12 + s22 * e22)

    def gradient(self, x, rest):
        (i11, i12, i22), volume, _, _ = rest
        f1, f2, _, (s11, s12, s22) = self.strain(x, rest)
        by_f1, by_f2 = s11 * f1 + s12 * f2, s12 * f1 + s22 * f2
        g1, g2 = volume * (i11 * by_f1 + i12 * by_f2), volume * i22 * by_f2
        return numpy.stack([-g1 - g2, g1, g2]).transpose(2, 0, 1)

    def hessian(self, x, rest):
        (i11, i12, i22), volume, mu, lam = rest
        f1, f2, _, (s11, s12, s22) = self.strain(x, rest)
        one = numpy.eye(3)[:, :, None]
        f11, f12, f22 = (a[:, None] * b[None] for a, b in ((f1, f1), (f1, f2), (f2, f2)))
        k11 = s11 * one + (lam + 2 * mu) * f11 + mu * f22
        k22 = s22 * one + (lam + 2 * mu) * f22 + mu * f11
        k12 = s12 * one + lam * f12 + mu * f12.swapaxes(0, 1)
        h = numpy.empty((3, 3, 3, 3, len(x)))  # vertex, axis, vertex, axis
        h[1, :, 1] = volume * i11**2 * k11 + volume * i11 * i12 * (k12 + k12.swapaxes(0, 1)) + volume * i12**2 * k22
        h[1, :, 2] = volume * i11 * i22 * k12 + volume * i12 * i22 * k22
        h[2, :, 1] = h[1, :, 2].swapaxes(0, 1)
        h[2, :, 2] = volume * i22**2 * k22
        h[0, :, 1:] = -h[1, :, 1:] - h[2, :, 1:]
        h[1:, :, 0] = h[0, :, 1:].transpose(1, 2, 0, 3)
        h[0, :, 0] = -h[0, :, 1] - h[0, :, 2]
        return h.reshape(9, 9, -1).transpose(2, 0, 1)


class Springs(drape.Energy):
    """Springs along the edges."""

    parameters = {"stiffness": drape.Parameter(50.0, unit="N/m", minimum=0, description="of every spring")}

    def elements(self, level):
        return level.edges

    def rest(self, level, material):
        ends = level.rest[level.edges]
        return numpy.linalg.norm(ends[:, 1] - ends[:, 0], axis=1)

    def value(self, x, rest):
        return self.stiffness / 2 * (numpy.linalg.norm(x[:, 1] - x[:, 0], axis=1) - rest) ** 2

    def gradient(self, x, rest):
        d = x[:, 1] - x[:, 0]
        length = numpy.linalg.norm(d, axis=1)
        g = (self.stiffness * (1 - rest / length))[:, None] * d
        return numpy.stack([-g, g], axis=1)

    def hessian(self, x, rest):
        d = x[:, 1] - x[:, 0]
        length = numpy.linalg.norm(d, axis=1)
        n = d / length[:, None]
        along, ratio = n[:, :, None] * n[:, None, :], (rest / length)[:, None, None]
        h = self.stiffness * (along + (1 - ratio) * (numpy.eye(3) - along))
        return numpy.block([[h, -h], [-h, h]])


class Height(drape.Metric):
    """The lowest and the mean height of a state."""

    columns = {"lowest_z": drape.Column(unit="m", better="neither"), "mean_z": drape.Column(unit="m")}

    def measure(self, level, x, other):
        return {"lowest_z": x[:, 2].min(), "mean_z": numpy.average(x[:, 2], weights=level.vertex_area)}


class Midpoint(drape.Refiner):
    """Splits every triangle at its edge midpoints."""

    def weights(self, level):
        n, edges = level.vertex_count, level.edges
        rows = numpy.repeat(numpy.arange(len(edges)), 2)
        half = scipy.sparse.csr_matrix((numpy.full(2 * len(edges), 0.5), (rows, edges.ravel())),
                                       shape=(len(edges), n))
        return scipy.sparse.vstack([scipy.sparse.identity(n), half]).tocsr()


class ProjectedNewton(drape.Solver):
    """Projected Newton with backtracking on the free vertices, level after level, each from the one before."""

    parameters = {"tolerance": 1e-3, "most": 300}

    def solve(self, problem):
        x = problem.start(0)
        for level in range(problem.level_count):
            if level > 0:
                x = problem.prolong(level - 1, x)
            problem.begin(level)
            x, status = self.minimise(problem, problem.model(level), x)
            problem.end(x, status)
            if status == "cancelled":
                return

    def minimise(self, problem, model, x):
        free = numpy.flatnonzero(numpy.repeat(~model.fixed, 3))
        for _ in range(self.most):
            g, p = model.gradient(x).ravel(), numpy.zeros(3 * len(x))
            h = scipy.sparse.csc_matrix(model.hessian(x, "clamp"))[free][:, free]
            p[free] = -scipy.sparse.linalg.spsolve(h + 1e-6 * scipy.sparse.identity(len(free)), g[free])
            energy, length = model.energy(x), 1.0
            while model.energy(x + length * p.reshape(-1, 3)) > energy + 1e-4 * length * (g @ p):
                length /= 2
            x = x + length * p.reshape(-1, 3)
            if not problem.iteration(x, step_length=length):
                return x, "cancelled"
            if model.force_residual(x) < self.tolerance:
                return x, "converged"
        return x, "max_steps_reached"
