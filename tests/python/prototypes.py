"""Prototypes that tests, the guide and the benchmark share."""

import numpy
import scipy.sparse
import scipy.sparse.linalg

import drape


class NumpyStvk(drape.Energy):
    """The St. Venant-Kirchhoff membrane, as plugins/energy/stvk, in numpy."""

    role = "membrane"
    midpoint_factor = 1.0

    def elements(self, level):
        return level.triangles

    def rest(self, level, material):
        x = level.rest[level.triangles]
        e1, e2 = x[:, 1] - x[:, 0], x[:, 2] - x[:, 0]
        length = numpy.linalg.norm(e1, axis=1)
        twice_area = numpy.linalg.norm(numpy.cross(e1, e2), axis=1)
        shape = numpy.zeros((len(x), 2, 2))  # the edges in the triangle's own plane, as columns
        shape[:, 0, 0] = length
        shape[:, 0, 1] = numpy.einsum("mi,mi->m", e1, e2) / length
        shape[:, 1, 1] = twice_area / length
        inverse = numpy.linalg.inv(shape)
        b = numpy.concatenate([-inverse.sum(axis=1, keepdims=True), inverse], axis=1)  # m×3×2: F = xᵀ b
        nu = material.poisson_ratio
        mu = material.membrane_modulus / (2 * (1 + nu))
        lam = material.membrane_modulus * nu / (1 - nu * nu)
        return b, material.thickness * twice_area / 2, mu, lam

    def strain(self, x, rest):
        b, _, mu, lam = rest
        f = numpy.einsum("mvi,mva->mia", x - x[:, :1], b)
        green = (numpy.einsum("mia,mib->mab", f, f) - numpy.eye(2)) / 2
        trace = numpy.trace(green, axis1=1, axis2=2)
        return f, green, trace, 2 * mu * green + lam * trace[:, None, None] * numpy.eye(2)

    def value(self, x, rest):
        _, volume, mu, lam = rest
        _, green, trace, _ = self.strain(x, rest)
        return volume * (mu * (green**2).sum(axis=(1, 2)) + lam / 2 * trace**2)

    def gradient(self, x, rest):
        b, volume, _, _ = rest
        f, _, _, stress = self.strain(x, rest)
        return numpy.einsum("m,mia,mab,mvb->mvi", volume, f, stress, b)

    def hessian(self, x, rest):
        b, volume, mu, lam = rest
        f, _, _, stress = self.strain(x, rest)
        one3, one2 = numpy.eye(3), numpy.eye(2)
        k = (numpy.einsum("ij,mab->miajb", one3, stress) + lam * numpy.einsum("mia,mjb->miajb", f, f)
             + mu * numpy.einsum("mib,mja->miajb", f, f)
             + mu * numpy.einsum("ab,mic,mjc->miajb", one2, f, f))
        h = numpy.einsum("m,mva,miajb,mwb->mviwj", volume, b, k, b, optimize=True)
        return h.reshape(len(x), 9, 9)


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

    def refine(self, level):
        n, edges, t = level.vertex_count, level.edges, level.triangles
        a, b, c = (n + level.triangle_edges).T  # opposite the corners 0, 1, 2
        triangles = numpy.stack([
            numpy.stack([t[:, 0], c, b], axis=1), numpy.stack([c, t[:, 1], a], axis=1),
            numpy.stack([b, a, t[:, 2]], axis=1), numpy.stack([a, b, c], axis=1)], axis=1).reshape(-1, 3)
        rows = numpy.repeat(numpy.arange(len(edges)), 2)
        half = scipy.sparse.csr_matrix((numpy.full(2 * len(edges), 0.5), (rows, edges.ravel())),
                                       shape=(len(edges), n))
        return triangles, scipy.sparse.vstack([scipy.sparse.identity(n), half]).tocsr()


def newton_step(model, x, shift):
    """The state after a step of projected Newton with backtracking on the free vertices, and the length of the step; `shift`
    is added to the Hessian's diagonal [N/m]."""
    free = numpy.flatnonzero(numpy.repeat(~model.fixed, 3))
    g = model.gradient(x).ravel()
    h = scipy.sparse.csc_matrix(model.hessian(x, "clamp"))[free][:, free]
    p = numpy.zeros_like(g)
    p[free] = -scipy.sparse.linalg.spsolve(h + shift * scipy.sparse.identity(len(free)), g[free])
    energy, length = model.energy(x), 1.0
    while model.energy(x + length * p.reshape(-1, 3)) > energy + 1e-4 * length * (g @ p):
        length /= 2
    return x + length * p.reshape(-1, 3), length


class ProjectedNewton(drape.Solver):
    """Projected Newton with backtracking, level after level, each from the one before."""

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
        for _ in range(self.most):
            x, length = newton_step(model, x, 1e-6)
            if not problem.iteration(x, step_length=length):
                return x, "cancelled"
            if model.force_residual(x) < self.tolerance:
                return x, "converged"
        return x, "max_steps_reached"
