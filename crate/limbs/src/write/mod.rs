//! Writers of files.

mod block;
mod obj;
mod swc;

use crate::error::Remark;

/// Text of a file.
#[derive(Clone, Debug, PartialEq)]
pub struct Written {
    /// The text.
    pub text: String,
    /// Sentences about what the format cannot say of the graph.
    pub remarks: Vec<Remark>,
}

impl Written {
    /// Adds a remark about some limbs or nodes, if there are any. `text` follows on their number.
    fn remark_count(&mut self, count: usize, text: &str) {
        if count > 0 {
            let text = format!("{count} {text}");
            self.remarks.push(Remark { line: None, text });
        }
    }
}
