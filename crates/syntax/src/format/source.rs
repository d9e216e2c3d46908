//! The tokens and comments of a file, in order, as documents.
//!
//! The tree gives the structure. The tokens and comments themselves come from the text, so that
//! none is lost and numbers stay as they were written.

use super::doc::{Doc, NOTHING, comment, concat, text};
use crate::lexer::{Comment, Lexed};
use crate::token::{Token, TokenKind};

pub(super) struct Source<'a> {
    text: &'a str,
    tokens: &'a [Token],
    comments: &'a [Comment],
    /// Index of the next token.
    at: usize,
    /// Index of the next comment.
    next_comment: usize,
}

impl<'a> Source<'a> {
    pub fn new(text: &'a str, lexed: &'a Lexed) -> Self {
        let (tokens, comments) = (&lexed.tokens[..], &lexed.comments[..]);
        Source { text, tokens, comments, at: 0, next_comment: 0 }
    }

    pub fn kind(&self) -> TokenKind {
        self.tokens.get(self.at).map_or(TokenKind::Eof, |token| token.kind)
    }

    /// Takes the next token with the comments before it. Colours become lower case.
    pub fn take(&mut self) -> Doc<'a> {
        let comments = self.comments();
        let Some(token) = self.tokens.get(self.at) else {
            return comments;
        };
        self.at += 1;
        let written = &self.text[token.start as usize..token.end as usize];
        let color = token.kind == TokenKind::Color;
        let token = if color { text(written.to_lowercase()) } else { text(written) };
        if comments.hard { concat(vec![comments, token]) } else { token }
    }

    /// Takes the next `count` tokens, without space between them.
    pub fn take_joined(&mut self, count: usize) -> Doc<'a> {
        concat((0..count).map(|_| self.take()).collect())
    }

    /// Takes the next token and adds a space.
    pub fn take_spaced(&mut self) -> Doc<'a> {
        concat(vec![self.take(), text(" ")])
    }

    /// Skips a token of this kind if it comes next. The comments before it go to the token after
    /// it.
    pub fn skip(&mut self, kind: TokenKind) -> bool {
        let found = self.kind() == kind;
        self.at += usize::from(found);
        found
    }

    /// Takes all comments before the next token.
    pub fn comments(&mut self) -> Doc<'a> {
        self.comments_while(|_, _| true)
    }

    /// Takes the comments on the same line as the token before them.
    pub fn trailing_comments(&mut self) -> Doc<'a> {
        self.comments_while(|source, comment| !source.on_own_line(comment))
    }

    /// Returns true if no token precedes a comment on its line.
    fn on_own_line(&self, comment: &Comment) -> bool {
        let before = comment.tokens_before.checked_sub(1).and_then(|at| self.tokens.get(at));
        before.is_none_or(|token| {
            self.text[token.end as usize..comment.start as usize].contains('\n')
        })
    }

    fn comments_while(&mut self, wanted: impl Fn(&Self, &Comment) -> bool) -> Doc<'a> {
        let mut docs = Vec::new();
        while let Some(&next) = self.comments.get(self.next_comment) {
            if next.tokens_before > self.at || !wanted(self, &next) {
                break;
            }
            self.next_comment += 1;
            let blank_after = self.blank_before_next(next.end);
            docs.push(comment(next.text(self.text), self.on_own_line(&next), blank_after));
        }
        if docs.is_empty() { NOTHING } else { concat(docs) }
    }

    /// Returns true if there is a blank line between the last taken token and the next.
    pub fn blank_before(&self) -> bool {
        let before = self.at.checked_sub(1).and_then(|at| self.tokens.get(at));
        let comment = self.next_comment.checked_sub(1).and_then(|at| self.comments.get(at));
        let token_end = before.map(|token| token.end);
        let end = token_end.max(comment.map(|comment| comment.end));
        end.is_some_and(|end| self.blank_before_next(end))
    }

    /// Returns true if there is a blank line between `end` and the next token or comment.
    fn blank_before_next(&self, end: u32) -> bool {
        let token = self.tokens.get(self.at).map(|token| token.start);
        let comment = self.comments.get(self.next_comment).map(|comment| comment.start);
        let next = match (token, comment) {
            (Some(token), Some(comment)) => token.min(comment),
            (token, comment) => token.or(comment).unwrap_or(end),
        };
        let between = self.text.get(end as usize..next as usize).unwrap_or("");
        between.matches('\n').count() > 1
    }

    /// Returns true if a line ends between the next token, an opening bracket, and its closing one.
    pub fn opens_lines(&self) -> bool {
        let mut open = 0_usize;
        for token in self.tokens.iter().skip(self.at) {
            if open > 0 && token.first {
                return true;
            }
            if token.kind.closer().is_some() {
                open += 1;
            } else if token.kind.is_closer() {
                open = open.saturating_sub(1);
                if open == 0 {
                    return false;
                }
            }
        }
        false
    }
}
