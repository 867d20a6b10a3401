"""Error measures, bars and verdicts. No other package decides whether a result has passed or missed a bar."""

from partialslip.run.judge.comparison import Comparison as Comparison
from partialslip.run.judge.comparison import compare as compare
from partialslip.run.judge.measures import cell_errors as cell_errors
from partialslip.run.judge.measures import cell_means as cell_means
from partialslip.run.judge.verdicts import ESTIMATE as ESTIMATE
from partialslip.run.judge.verdicts import NO_BAR as NO_BAR
from partialslip.run.judge.verdicts import P_BAR as P_BAR
from partialslip.run.judge.verdicts import Q_BAR as Q_BAR
from partialslip.run.judge.verdicts import Bar as Bar
from partialslip.run.judge.verdicts import Conclusion as Conclusion
from partialslip.run.judge.verdicts import Outcome as Outcome
from partialslip.run.judge.verdicts import Verdict as Verdict
from partialslip.run.judge.verdicts import conclude as conclude
from partialslip.run.judge.verdicts import conditions as conditions
from partialslip.run.judge.verdicts import estimate_verdicts as estimate_verdicts
from partialslip.run.judge.verdicts import judged as judged
from partialslip.run.judge.verdicts import of_run as of_run
from partialslip.run.judge.verdicts import together as together
from partialslip.tools.bars import BARS as BARS
