//! Tokens with matched brackets, which show where an item ends.

use super::fault::Fault;
use super::token::{Kind, Token, tokens};

/// Tokens of one text.
#[derive(Clone, Debug)]
pub(super) struct Code<'a> {
    pub text: &'a str,
    pub tokens: Vec<Token>,
    /// Index of the closing bracket for each opening bracket; for other tokens, their own index.
    close: Vec<usize>,
}

impl<'a> Code<'a> {
    /// Reads a text.
    ///
    /// # Errors
    ///
    /// If a comment or a bracket is not closed, or a closing bracket has no opening one.
    pub fn new(text: &'a str) -> Result<Self, Fault> {
        Self::of(text, tokens(text)?)
    }

    /// Wraps some of the tokens of a text, in order.
    ///
    /// # Errors
    ///
    /// If their brackets do not match.
    pub fn of(text: &'a str, tokens: Vec<Token>) -> Result<Self, Fault> {
        let mut close: Vec<usize> = (0..tokens.len()).collect();
        let mut open: Vec<(usize, char)> = Vec::new();
        for (at, token) in tokens.iter().enumerate() {
            match token.kind {
                Kind::Mark('(') => open.push((at, ')')),
                Kind::Mark('[') => open.push((at, ']')),
                Kind::Mark('{') => open.push((at, '}')),
                Kind::Mark(mark @ (')' | ']' | '}')) => match open.pop() {
                    Some((start, wanted)) if wanted == mark => close[start] = at,
                    Some((start, wanted)) => {
                        let from = tokens[start].line;
                        let message = format!("expected `{wanted}` for the bracket of line {from}, found `{mark}`");
                        return Err(Fault::new(token.line, message));
                    }
                    None => return Err(Fault::new(token.line, format!("`{mark}` closes no bracket"))),
                },
                _ => {}
            }
        }
        match open.pop() {
            Some((at, wanted)) => {
                Err(Fault::new(tokens[at].line, format!("the `{wanted}` of this bracket is missing")))
            }
            None => Ok(Self { text, tokens, close }),
        }
    }

    /// Returns the text of a token; empty after the last token.
    pub fn word(&self, at: usize) -> &'a str {
        self.tokens.get(at).map_or("", |token| &self.text[token.start..token.end])
    }

    /// Returns true if a token is this mark.
    pub fn is(&self, at: usize, mark: char) -> bool {
        self.tokens.get(at).is_some_and(|token| token.kind == Kind::Mark(mark))
    }

    /// Returns true if a token is a word.
    pub fn is_word(&self, at: usize) -> bool {
        self.tokens.get(at).is_some_and(|token| token.kind == Kind::Word)
    }

    /// Returns the index of the closing bracket for an opening one; for other tokens, the same index.
    pub fn close(&self, at: usize) -> usize {
        self.close.get(at).copied().unwrap_or(at)
    }

    /// Returns the line of a token, or of the last one.
    pub fn line(&self, at: usize) -> usize {
        self.tokens.get(at).or(self.tokens.last()).map_or(1, |token| token.line)
    }

    /// Returns the first token after the attributes that begin at `at`.
    pub fn after_attributes(&self, mut at: usize) -> usize {
        while self.is(at, '@') {
            at += 2;
            if self.is(at, '(') {
                at = self.close(at) + 1;
            }
        }
        at
    }

    /// Returns the index after the last token of the declaration or statement that begins at `start`, at most `end`.
    pub fn statement_end(&self, start: usize, end: usize) -> usize {
        let mut at = self.after_attributes(start);
        let keyword = self.word(at);
        let ends_with_block = matches!(
            keyword,
            "{" | "fn" | "struct" | "if" | "for" | "while" | "loop" | "continuing" | "switch" | "case" | "default"
        );
        while at < end {
            if self.is(at, '{') && ends_with_block {
                at = self.close(at) + 1;
                if keyword != "if" || self.word(at) != "else" {
                    return at.min(end);
                }
            } else if self.is(at, ';') && !ends_with_block {
                return at + 1;
            } else {
                at = self.close(at) + 1;
            }
        }
        end
    }

    /// Returns the index after the comma that follows the parameter or member at `start`, at most `end`.
    pub fn member_end(&self, start: usize, end: usize) -> usize {
        let (mut at, mut templates) = (start, 0_usize);
        while at < end {
            match self.tokens[at].kind {
                Kind::Mark('<') => templates += 1,
                Kind::Mark('>') => templates = templates.saturating_sub(1),
                Kind::Mark(',') if templates == 0 => return at + 1,
                _ => {}
            }
            at = self.close(at) + 1;
        }
        end
    }
}
