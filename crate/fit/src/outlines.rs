//! Outlines: polylines in pictures, with the camera of each picture.

use crate::error::{Error, fail};
use crate::problem::MAX_OBSERVATIONS;
use crate::sight::Sight;
use glam::{DVec2, DVec3};
use serde::{Deserialize, Serialize};

/// The outline of a shape in one picture of a camera with a pinhole.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Outline {
    /// Place of the camera.
    pub eye: [f64; 3],
    /// Point in the middle of the picture.
    pub target: [f64; 3],
    /// Direction that is up in the picture.
    pub up: [f64; 3],
    /// The angle between the left and the right edge, degrees.
    pub fov: f64,
    /// Width and height of the picture, pixels.
    pub size: [f64; 2],
    /// The lines, in pixels from the left and from the top.
    pub lines: Vec<Vec<[f64; 2]>>,
}

impl Outline {
    /// Returns the direction in which a place of the picture is seen, a unit vector; `None` if the
    /// camera looks nowhere.
    #[must_use]
    pub fn direction(&self, pixel: [f64; 2]) -> Option<DVec3> {
        let [eye, target, up] = [self.eye, self.target, self.up].map(DVec3::from_array);
        let forward = (target - eye).try_normalize()?;
        let right = forward.cross(up).try_normalize()?;
        let down = forward.cross(right);
        let [width, height] = self.size;
        let half = libm::tan(0.5 * self.fov.to_radians());
        let across = DVec2::new(pixel[0] - 0.5 * width, pixel[1] - 0.5 * height);
        let across = across * (2.0 * half / width);
        (forward + right * across.x + down * across.y).try_normalize()
    }
}

/// Reads outlines: a JSON list of [`Outline`]s.
///
/// # Errors
/// Says what is wrong: no JSON of that form, a camera that looks nowhere, places outside the
/// picture, no lines at all.
///
/// ```
/// let text = r#"[{"eye": [0, -5, 0], "target": [0, 0, 0], "up": [0, 0, 1],
///                 "fov": 40, "size": [100, 100], "lines": [[[20, 50], [50, 20]]]}]"#;
/// let outlines = fit::outlines(text.as_bytes())?;
/// assert_eq!(outlines[0].direction([50.0, 50.0]), Some(glam::DVec3::Y));
/// # Ok::<(), fit::Error>(())
/// ```
pub fn outlines(bytes: &[u8]) -> Result<Vec<Outline>, Error> {
    let outlines: Vec<Outline> = serde_json::from_slice(bytes)
        .map_err(|error| Error(format!("these are no outlines: {error}")))?;
    let mut count = 0;
    for (outline, number) in outlines.iter().zip(1..) {
        let [width, height] = outline.size;
        let is_sized = [width, height].iter().all(|s| s.is_finite() && *s > 0.0);
        let is_lens = outline.fov > 0.0 && outline.fov < 180.0;
        if !is_sized || !is_lens {
            return fail(format!(
                "outline {number}: its size or its fov is out of range (fov from 0 to 180 degrees)"
            ));
        }
        if outline.direction([0.0, 0.0]).is_none() {
            return fail(format!("outline {number}: its camera looks nowhere"));
        }
        for [x, y] in outline.lines.iter().flatten() {
            let on_screen = (0.0..=width).contains(x) && (0.0..=height).contains(y);
            if !on_screen {
                return fail(format!(
                    "outline {number}: the place {x} {y} is outside its picture of {width} × \
                     {height} pixels"
                ));
            }
            count += 1;
        }
    }
    match count {
        0 => fail("there are no lines in these outlines"),
        _ if count > MAX_OBSERVATIONS => fail(format!(
            "these outlines have {count} places, more than the {MAX_OBSERVATIONS} that a fit takes"
        )),
        _ => Ok(outlines),
    }
}

/// Returns the lines of sight through all places of outlines.
#[must_use]
pub fn sights(outlines: &[Outline]) -> Vec<Sight> {
    outlines
        .iter()
        .flat_map(|outline| {
            let places = outline.lines.iter().flatten();
            places
                .filter_map(|pixel| {
                    Some(Sight {
                        origin: DVec3::from_array(outline.eye),
                        direction: outline.direction(*pixel)?,
                    })
                })
                .collect::<Vec<_>>()
        })
        .collect()
}
