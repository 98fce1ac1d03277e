"""The job of the table by Pillow and numpy: pillow.py IN OUT rows|columns. Exit status 77: they are not there."""
import sys

try:
    import numpy
    from PIL import Image
except ImportError:
    sys.exit(77)

Image.MAX_IMAGE_PIXELS = None
pixels = numpy.asarray(Image.open(sys.argv[1]))
lines = pixels.T.copy() if sys.argv[3] == "columns" else pixels.copy()
lines[1::2] = lines[1::2, ::-1].copy()
numpy.packbits(lines, axis=1).tofile(sys.argv[2])
