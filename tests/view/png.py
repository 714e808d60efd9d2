"""PNG files as numpy arrays, read by libpng."""
import ctypes

import numpy

VERSION, FORMAT_RGBA = 1, 3


class Image(ctypes.Structure):
    _fields_ = [("opaque", ctypes.c_void_p), ("version", ctypes.c_uint32), ("width", ctypes.c_uint32), ("height", ctypes.c_uint32), ("format", ctypes.c_uint32), ("flags", ctypes.c_uint32),
                ("colormap_entries", ctypes.c_uint32), ("warning_or_error", ctypes.c_uint32), ("message", ctypes.c_char * 64)]


def read(file):
    """Height x width x RGB, 0 to 255, signed so that differences are right."""
    png = ctypes.CDLL("libpng16.so.16")
    image = Image(version=VERSION)
    if not png.png_image_begin_read_from_file(ctypes.byref(image), str(file).encode()):
        raise RuntimeError(f"{file}: {image.message.decode()}")
    image.format = FORMAT_RGBA
    pixels = numpy.empty((image.height, image.width, 4), numpy.uint8)
    if not png.png_image_finish_read(ctypes.byref(image), None, pixels.ctypes.data_as(ctypes.c_void_p), 0, None):
        raise RuntimeError(f"{file}: {image.message.decode()}")
    return pixels[:, :, :3].astype(numpy.int16)
