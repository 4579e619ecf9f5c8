"""The little geometry that objects need. Vectors are tuples of three, matrices tuples of three rows."""

IDENTITY = ((1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0))
_NORM_TOLERANCE = 0.01  # of a quaternion; printed and float32 ones are not exact


def rotation(x, y, z, w):
    """Rotation matrix of a quaternion; None if it is none (norm not 1). All zeros, a field left empty, is no rotation."""
    norm = (x * x + y * y + z * z + w * w) ** 0.5
    if norm == 0.0:
        return IDENTITY
    if not abs(norm - 1.0) <= _NORM_TOLERANCE:
        return None
    x, y, z, w = x / norm, y / norm, z / norm, w / norm
    return ((1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)),
            (2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)),
            (2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)))


def rotated(R, v):
    """R v."""
    return tuple(sum(R[i][k] * v[k] for k in range(3)) for i in range(3))


def product(A, B):
    """A B."""
    return tuple(tuple(sum(A[i][k] * B[k][j] for k in range(3)) for j in range(3)) for i in range(3))


def rotated_covariance(R, C):
    """R C R^T."""
    return product(product(R, C), tuple(zip(*R)))


def extents(R, size):
    """Extents along the axes of a frame of a box of `size` along its own axes, R = R_frame_box."""
    return tuple(sum(abs(R[i][k]) * size[k] for k in range(3)) for i in range(3))


def axes_matrix(axes):
    """The matrix of names such as ["x", "-y", "z"]: row i takes the named axis of the message, with its sign."""
    return tuple(tuple((-1.0 if axis.startswith("-") else 1.0) if axis.lstrip("-") == name else 0.0 for name in "xyz")
                 for axis in (str(a) for a in axes))
