"""Error measures, bars and verdicts. No other package decides whether a result has passed or missed a bar."""

from partialslip.run.judge.comparison import Comparison as Comparison
from partialslip.run.judge.comparison import compare as compare
from partialslip.run.judge.estimates import ESTIMATE as ESTIMATE
from partialslip.run.judge.estimates import estimate_verdicts as estimate_verdicts
from partialslip.run.judge.means import cell_errors as cell_errors
from partialslip.run.judge.means import cell_means as cell_means
from partialslip.run.judge.outcome import Conclusion as Conclusion
from partialslip.run.judge.outcome import conclude as conclude
from partialslip.run.judge.outcome import of_run as of_run
from partialslip.run.judge.outcome import together as together
from partialslip.run.judge.verdict import NO_BAR as NO_BAR
from partialslip.run.judge.verdict import P_BAR as P_BAR
from partialslip.run.judge.verdict import Q_BAR as Q_BAR
from partialslip.run.judge.verdict import Bar as Bar
from partialslip.run.judge.verdict import Outcome as Outcome
from partialslip.run.judge.verdict import Verdict as Verdict
from partialslip.run.judge.verdict import conditions as conditions
from partialslip.run.judge.verdict import judged as judged
from partialslip.tools.bars import BARS as BARS
