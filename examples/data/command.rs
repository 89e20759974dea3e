//! What the commands among the examples share: errors in words, pictures to a PNG.

use embedded_graphics::pixelcolor::{PixelColor, Rgb888};
use embedded_graphics_simulator::{OutputSettings, SimulatorDisplay};
use std::error::Error;
use std::path::Path;
use std::process::ExitCode;

/// How a command ends: an error is told on standard error.
pub(crate) fn end(outcome: Result<(), Box<dyn Error>>) -> ExitCode {
    match outcome {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("error: {error}");
            ExitCode::FAILURE
        }
    }
}

/// Writes the display's picture; an error names the file.
pub(crate) fn save_png<C: PixelColor + Into<Rgb888>>(
    display: &SimulatorDisplay<C>,
    settings: &OutputSettings,
    path: &Path,
) -> Result<(), Box<dyn Error>> {
    if path.extension().is_none_or(|extension| !extension.eq_ignore_ascii_case("png")) {
        return Err(format!("{}: pictures are written as .png", path.display()).into());
    }
    let image = display.to_rgb_output_image(settings);
    image.save_png(path).map_err(|error| format!("{}: {error}", path.display()).into())
}
