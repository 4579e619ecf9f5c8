"""An ONNX file with one convolution of 1x1 pixels, of three channels to three classes, as support/tiny_network.h makes it."""
import struct

FLOAT, INTS = 1, 7


def varint(value):
    more = b""
    while value >= 128:
        more += bytes([value & 127 | 128])
        value >>= 7
    return more + bytes([value])


def field(number, value):
    """A field of a protocol buffer: a whole number, or bytes that are a text or a message."""
    if isinstance(value, int):
        return varint(number << 3) + varint(value)
    return varint(number << 3 | 2) + varint(len(value)) + value


def tensor(name, shape, values):
    return (b"".join(field(1, size) for size in shape) + field(2, FLOAT) + field(8, name) +
            field(9, struct.pack(f"<{len(values)}f", *values)))


def value_of(name, shape):
    dimensions = b"".join(field(1, field(1, size)) for size in shape)
    return field(1, name) + field(2, field(1, field(1, FLOAT) + field(2, dimensions)))


def write_tiny_network(path):
    """Each class has the score of its channel."""
    kernel = field(1, b"kernel_shape") + field(8, 1) * 2 + field(20, INTS)
    node = (field(1, b"image") + field(1, b"weights") + field(1, b"biases") + field(2, b"scores") + field(3, b"layer") +
            field(4, b"Conv") + field(5, kernel))
    graph = (field(1, node) + field(2, b"tiny") + field(5, tensor(b"weights", (3, 3, 1, 1), (1, 0, 0, 0, 1, 0, 0, 0, 1))) +
             field(5, tensor(b"biases", (3,), (0, 0, 0))) + field(11, value_of(b"image", (1, 3, 8, 8))) +
             field(12, value_of(b"scores", (1, 3, 8, 8))))
    with open(path, "wb") as file:
        file.write(field(1, 7) + field(2, b"test") + field(7, graph) + field(8, field(1, b"") + field(2, 11)))
