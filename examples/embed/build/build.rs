fn main() -> Result<(), sdfc_build::Error> {
    sdfc_build::Build::new().scene("../bowl.sdf")
}
