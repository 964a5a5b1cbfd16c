"""The 8-node quadrilateral: shape functions, sampling of nodal fields, patches of Gauss points."""

import numpy as np
import numpy.typing as npt

GAUSS = np.array([[-1, -1], [1, -1], [1, 1], [-1, 1]]) / np.sqrt(3)
CORNERS = np.array([[-1, -1], [1, -1], [1, 1], [-1, 1]])
MIDSIDES = np.array([[0, -1], [1, 0], [0, 1], [-1, 0]])
# Triangles that use all eight nodes, for contours of nodal fields.
TRIANGLES = np.array([[0, 4, 7], [4, 1, 5], [5, 2, 6], [6, 3, 7], [4, 5, 7], [5, 6, 7]])


def shape(xi: npt.ArrayLike, eta: npt.ArrayLike) -> np.ndarray:
    """Serendipity shape functions at points; (..., 8)."""
    xi, eta = np.asarray(xi)[..., None], np.asarray(eta)[..., None]
    a, b = CORNERS[:, 0], CORNERS[:, 1]
    corner = 0.25 * (1 + a * xi) * (1 + b * eta) * (a * xi + b * eta - 1)
    along_xi = 0.5 * (1 - xi**2) * (1 + MIDSIDES[[0, 2], 1] * eta)
    along_eta = 0.5 * (1 - eta**2) * (1 + MIDSIDES[[1, 3], 0] * xi)
    sides = np.stack([along_xi[..., 0], along_eta[..., 0], along_xi[..., 1], along_eta[..., 1]], axis=-1)
    return np.concatenate([corner, sides], axis=-1)


def triangles(connectivity: np.ndarray) -> np.ndarray:
    return connectivity[:, TRIANGLES].reshape(-1, 3)


def outlines(coordinates: np.ndarray, connectivity: np.ndarray) -> np.ndarray:
    """Element edges through their midsides; (element, 9, 2)."""
    return coordinates[connectivity[:, [0, 4, 1, 5, 2, 6, 3, 7, 0]]]


def gauss_coordinates(coordinates: np.ndarray, connectivity: np.ndarray) -> np.ndarray:
    """Gauss points, point p next to corner p; (element, 4, 2)."""
    return np.einsum("gn,enk->egk", shape(GAUSS[:, 0], GAUSS[:, 1]), coordinates[connectivity])


def gauss_patches(coordinates: np.ndarray, connectivity: np.ndarray) -> np.ndarray:
    """The quarter of an element around each Gauss point, as a polygon; (element, 4, 4, 2).

    A quarter is drawn in one colour, because each point is one RVE and smoothing would hide how localised a field is.
    """
    nodes = coordinates[connectivity]
    centre = np.einsum("n,enk->ek", shape(0.0, 0.0), nodes)
    return np.stack(
        [np.stack([nodes[:, c], nodes[:, 4 + c], centre, nodes[:, 4 + (c + 3) % 4]], axis=1) for c in range(4)], axis=1
    )


def gauss_weights(local: npt.ArrayLike) -> np.ndarray:
    """Weights of an element's four Gauss points (n, 4) at local coordinates (n, 2): bilinear between the points,
    constant outside, because fields of RVEs must not be extrapolated."""
    a = np.clip(np.asarray(local) * np.sqrt(3), -1, 1)
    return 0.25 * (1 + a[:, :1] * CORNERS[:, 0]) * (1 + a[:, 1:] * CORNERS[:, 1])


def locate(coordinates: np.ndarray, connectivity: np.ndarray, points: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """The elements that hold points (n, 2): their nodes (n, 8) and the shape functions there (n, 8), NaN outside the
    mesh."""
    nodes_of, weights = np.zeros((len(points), 8), dtype=int), np.full((len(points), 8), np.nan)
    nodes = coordinates[connectivity]
    slack = 1e-6 * np.ptp(coordinates[:, 0])
    low, high = nodes.min(axis=1) - slack, nodes.max(axis=1) + slack
    for k, point in enumerate(points):
        for element in np.flatnonzero(np.all((low <= point) & (point <= high), axis=1)):
            local = local_coordinates(nodes[element], point)
            if local is not None:
                nodes_of[k], weights[k] = connectivity[element], shape(*local)
                break
    return nodes_of, weights


def sample(coordinates: np.ndarray, connectivity: np.ndarray, values: np.ndarray, points: np.ndarray) -> np.ndarray:
    """A nodal field (node, components) at points (n, 2); NaN outside the mesh."""
    nodes, weights = locate(coordinates, connectivity, points)
    return np.einsum("pn,pnk->pk", weights, values[nodes])


def local_coordinates(nodes: np.ndarray, point: np.ndarray, tolerance: float = 1e-6) -> np.ndarray | None:
    """Inverse of an element's map (nodes (8, 2)) by Newton; None where the point is outside."""
    local: np.ndarray = np.zeros(2)
    for _ in range(20):
        step = 1e-6
        here = shape(*local) @ nodes
        jacobian = np.column_stack(
            [
                (shape(local[0] + step, local[1]) - shape(local[0] - step, local[1])) @ nodes,
                (shape(local[0], local[1] + step) - shape(local[0], local[1] - step)) @ nodes,
            ]
        )
        jacobian /= 2 * step
        if abs(np.linalg.det(jacobian)) < 1e-14:
            return None
        change = np.linalg.solve(jacobian, point - here)
        local = np.clip(local + change, -2, 2)
        if np.max(np.abs(change)) < 1e-10:
            break
    inside = np.all(np.abs(local) <= 1 + tolerance) and np.allclose(shape(*local) @ nodes, point, atol=1e-5)
    return np.clip(local, -1, 1) if inside else None
