//! What is shown held against the oracle: what was asked of the judge, and what came of it.

use std::sync::mpsc::{Receiver, channel};

use crate::judge::{Case, Judge, Judged, Judgement};

/// The judge, and what it said.
#[derive(Debug)]
pub struct Comparing {
    judge: Judge,
    judged: Receiver<Judged>,
    /// How far off a picture was.
    pub judgement: Option<Box<Judgement>>,
    /// Why that of the last one is not known.
    pub unjudged: Option<String>,
    /// Whether each picture is compared once it rests.
    pub at_rest: bool,
    /// The last one that was to be.
    tried: Option<Case>,
}

impl Comparing {
    /// With nothing compared yet. `wake` is called when there is something to [`poll`](Self::poll).
    ///
    /// # Errors
    ///
    /// Where the system gives no thread.
    pub fn new(wake: impl Fn() + Send + Sync + 'static) -> std::io::Result<Self> {
        let (sender, judged) = channel();
        let judge = Judge::new(sender, wake)?;
        let (judgement, unjudged, at_rest, tried) = (None, None, false, None);
        Ok(Self { judge, judged, judgement, unjudged, at_rest, tried })
    }

    /// Takes in what the judge has to tell. Gives whether anything changed.
    pub fn poll(&mut self) -> bool {
        let mut changed = false;
        while let Ok(judged) = self.judged.try_recv() {
            match judged {
                Judged::Judgement(judgement) => {
                    (self.judgement, self.unjudged) = (Some(judgement), None);
                }
                Judged::Failed(why) => self.unjudged = Some(why),
                Judged::Cancelled => {}
            }
            changed = true;
        }
        changed
    }

    /// Has a picture compared, or all methods.
    pub fn ask(&mut self, case: Case) {
        self.unjudged = None;
        self.tried = Some(case.clone());
        self.judge.ask(case);
    }

    /// Has a picture compared unless it was the last one.
    pub fn ask_once(&mut self, case: Case) {
        if !self.tried.as_ref().is_some_and(|it| it.draws_as(&case)) {
            self.ask(case);
        }
    }

    /// Gives up.
    pub fn stop(&mut self) {
        self.judge.cancel();
        (self.at_rest, self.tried) = (false, None);
    }

    /// Gives up, and knows nothing.
    pub fn forget(&mut self) {
        self.stop();
        (self.judgement, self.unjudged) = (None, None);
    }

    /// The part that is done of what is being compared, and of what.
    pub fn progress(&self) -> Option<(f32, &'static str)> {
        self.judge.progress()
    }
}
