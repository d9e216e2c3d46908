//! Starts `sdfc lsp` in Zed.

use zed_extension_api::{self as zed, Command, LanguageServerId, Result, Worktree};

struct Sdf;

impl zed::Extension for Sdf {
    fn new() -> Self {
        Self
    }

    fn language_server_command(&mut self, _: &LanguageServerId, folder: &Worktree) -> Result<Command> {
        let command = folder.which("sdfc").ok_or(
            "the program `sdfc` is not on the PATH; install it with: \
             cargo install --git https://github.com/sdfc/sdfc sdfc-cli",
        )?;
        Ok(Command { command, args: vec!["lsp".to_owned()], env: folder.shell_env() })
    }
}

zed::register_extension!(Sdf);
