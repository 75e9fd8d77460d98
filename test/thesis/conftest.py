"""Make the helpers of the core's tests known to the tests of the thesis's equations."""

from pathlib import Path
import sys

sys.path.append(str(Path(__file__).parents[1] / 'core'))
