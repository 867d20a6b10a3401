"""The scene: bodies, profile, friction and loads. Immutable, validated, SI units, independent of methods.

Signs: positive ``dQ`` and positive ``dsigma`` add up at x -> +a, so that the stick zone moves towards -a.
"""

from partialslip.scene.bodies import Bodies as Bodies
from partialslip.scene.bodies import Body as Body
from partialslip.scene.loads import Load as Load
from partialslip.scene.materials import Constants as Constants
from partialslip.scene.materials import Elastic as Elastic
from partialslip.scene.materials import Material as Material
from partialslip.scene.model import Friction as Friction
from partialslip.scene.model import Pressing as Pressing
from partialslip.scene.model import Scene as Scene
from partialslip.scene.profiles import FlatRounded as FlatRounded
from partialslip.scene.profiles import Hertz as Hertz
from partialslip.scene.profiles import Profile as Profile
from partialslip.scene.profiles import Tabulated as Tabulated
from partialslip.scene.settings import WIDTHS as WIDTHS
from partialslip.scene.settings import Effects as Effects
from partialslip.scene.settings import Fatigue as Fatigue
from partialslip.scene.settings import Fem as Fem
from partialslip.scene.table import LARGEST as LARGEST
from partialslip.scene.table import SMALLEST as SMALLEST
from partialslip.scene.table import Table as Table
