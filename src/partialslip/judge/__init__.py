"""Error measures, bars and verdicts. No other package decides whether a result has passed or missed a bar."""

from partialslip.bars import BARS as BARS
from partialslip.judge.comparison import Comparison as Comparison
from partialslip.judge.comparison import compare as compare
from partialslip.judge.estimates import ESTIMATE as ESTIMATE
from partialslip.judge.estimates import estimate_verdicts as estimate_verdicts
from partialslip.judge.means import cell_errors as cell_errors
from partialslip.judge.means import cell_means as cell_means
from partialslip.judge.outcome import Conclusion as Conclusion
from partialslip.judge.outcome import conclude as conclude
from partialslip.judge.outcome import of_run as of_run
from partialslip.judge.outcome import together as together
from partialslip.judge.verdict import NO_BAR as NO_BAR
from partialslip.judge.verdict import P_BAR as P_BAR
from partialslip.judge.verdict import Q_BAR as Q_BAR
from partialslip.judge.verdict import Bar as Bar
from partialslip.judge.verdict import Outcome as Outcome
from partialslip.judge.verdict import Verdict as Verdict
from partialslip.judge.verdict import conditions as conditions
from partialslip.judge.verdict import judged as judged
